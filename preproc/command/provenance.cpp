#include "preproc/command/provenance.hpp"

#include "preproc/command/piped_files.hpp"

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <scan2fea/version.hpp>

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <openssl/evp.h>

namespace scan2fea::command {
namespace {

struct Hashed {
  std::uint64_t bytes = 0;
  std::string sha256;
};

Hashed hash_of(std::istream& stream) {
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr);
  Hashed hashed;
  std::vector<char> block(1 << 20);
  while (stream.read(block.data(), static_cast<std::streamsize>(block.size())) || stream.gcount() > 0) {
    EVP_DigestUpdate(context.get(), block.data(), static_cast<std::size_t>(stream.gcount()));
    hashed.bytes += static_cast<std::uint64_t>(stream.gcount());
  }
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  EVP_DigestFinal_ex(context.get(), digest.data(), &size);
  for (unsigned i = 0; i < size; ++i) {
    char text[3];
    std::snprintf(text, sizeof text, "%02x", digest[i]);
    hashed.sha256 += text;
  }
  return hashed;
}

Json entry(const std::string& role, const std::filesystem::path& file, const std::filesystem::path& readable) {
  Json entry{{"role", role}, {"file", file.string()}, {"bytes", nullptr}, {"sha256", nullptr}};
  std::ifstream stream;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(readable, ignored)) stream.open(readable, std::ios::binary);
  if (!stream.is_open()) return entry;
  const Hashed hashed = hash_of(stream);
  entry["bytes"] = hashed.bytes;
  entry["sha256"] = hashed.sha256;
  return entry;
}

}  // namespace

Json program_json() {
  const std::string eigen = std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
                            std::to_string(EIGEN_MINOR_VERSION);
  return {{"name", "scan2fea"},
          {"version", library_version},
          {"libraries", {{"CGAL", SCAN2FEA_CGAL_VERSION}, {"TetGen", SCAN2FEA_TETGEN_VERSION}, {"Eigen", eigen}}}};
}

std::vector<std::string> arguments_of_process() {
  std::ifstream stream("/proc/self/cmdline", std::ios::binary);
  const std::string line{std::istreambuf_iterator<char>(stream), {}};
  std::vector<std::string> arguments;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t end = std::min(line.find('\0', at), line.size());
    arguments.push_back(line.substr(at, end - at));
    at = end + 1;
  }
  if (!arguments.empty()) arguments[0] = "scan2fea";  // wherever it was started from
  return arguments;
}

Json command_json(const std::vector<std::string>& arguments) {
  std::error_code ignored;
  return {{"folder", std::filesystem::current_path(ignored).string()}, {"arguments", arguments}};
}

Json inputs_json(const std::vector<ReadFile>& files) {
  Json list = Json::array();
  for (const ReadFile& file : files) list.push_back(entry(file.role, file.path, file_to_read(file.path)));
  return list;
}

Json outputs_json(const std::vector<WrittenFile>& files) {
  Json list = Json::array();
  for (const WrittenFile& file : files) list.push_back(entry(file.role, file.path, file.readable));
  return list;
}

}  // namespace scan2fea::command
