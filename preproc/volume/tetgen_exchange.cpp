#include "preproc/volume/tetgen_exchange.hpp"

#include "preproc/mesh/error.hpp"

#include <cstdint>
#include <fstream>
#include <type_traits>

namespace scan2fea {
namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double), "points are written as they lie in memory");

// The file has no name that says anything to a user.
IoError exchange_error(const char* what) {
  return IoError(
      {.what = what, .where = {}, .value = {}, .limit = {}, .advice = "more memory, or larger files (ulimit -f)"});
}

class Writer {
 public:
  explicit Writer(const std::filesystem::path& file) : stream_(file, std::ios::binary) {}

  template <class Container>
  void array(const Container& items) {
    static_assert(std::is_trivially_destructible_v<typename Container::value_type>);
    const std::uint64_t size = items.size();
    stream_.write(reinterpret_cast<const char*>(&size), sizeof size);
    stream_.write(reinterpret_cast<const char*>(items.data()),
                  static_cast<std::streamsize>(size * sizeof(typename Container::value_type)));
  }

  void finish() {
    stream_.close();
    if (!stream_) throw exchange_error("not all could be written that is passed to or from TetGen");
  }

 private:
  std::ofstream stream_;
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file)
      : stream_(file, std::ios::binary), bytes_(stream_ ? std::filesystem::file_size(file) : 0) {}

  template <class Container>
  void array(Container& items) {
    std::uint64_t size = 0;
    stream_.read(reinterpret_cast<char*>(&size), sizeof size);
    // A worker that was killed while it wrote leaves a short file: no allocation on its word.
    if (!stream_ || size > bytes_ / sizeof(typename Container::value_type))
      throw exchange_error("not all could be read that is passed to or from TetGen");
    items.resize(size);
    stream_.read(reinterpret_cast<char*>(items.data()),
                 static_cast<std::streamsize>(size * sizeof(typename Container::value_type)));
    if (!stream_) throw exchange_error("not all could be read that is passed to or from TetGen");
  }

 private:
  std::ifstream stream_;
  std::uint64_t bytes_;
};

}  // namespace

void write_exchange(const TetgenInput& input, const std::filesystem::path& file) {
  Writer writer(file);
  writer.array(input.switches);
  writer.array(input.points);
  writer.array(input.triangles);
  writer.finish();
}

void write_exchange(const TetgenOutput& output, const std::filesystem::path& file) {
  Writer writer(file);
  writer.array(output.points);
  writer.array(output.tetrahedra);
  writer.array(output.faces);
  writer.array(output.face_marker);
  writer.finish();
}

TetgenInput read_tetgen_input(const std::filesystem::path& file) {
  Reader reader(file);
  TetgenInput input;
  reader.array(input.switches);
  reader.array(input.points);
  reader.array(input.triangles);
  return input;
}

TetgenOutput read_tetgen_output(const std::filesystem::path& file) {
  Reader reader(file);
  TetgenOutput output;
  reader.array(output.points);
  reader.array(output.tetrahedra);
  reader.array(output.faces);
  reader.array(output.face_marker);
  return output;
}

}  // namespace scan2fea
