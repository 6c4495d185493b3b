#include "export/gmsh_module.hpp"
#include "export/msh.hpp"
#include "preproc/mesh/companion_file.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/output_file.hpp"

#include <dlfcn.h>

namespace scan2fea {
namespace {

namespace fs = std::filesystem;

// Loaded once and kept: the SDK does not survive unloading.
WriteByGmsh* load_writer() {
  const fs::path module = companion_file(gmsh_module_name);
  void* handle = ::dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = handle != nullptr ? ::dlsym(handle, write_by_gmsh_name) : nullptr;
  if (function == nullptr) {
    const char* reason = ::dlerror();
    throw IoError({.what = "MSH files cannot be written: the Gmsh module does not load",
                   .where = module.string(),
                   .value = reason != nullptr ? reason : "",
                   .limit = {},
                   .advice = "install scan2fea anew, with the module"});
  }
  return reinterpret_cast<WriteByGmsh*>(function);
}

}  // namespace

void write_msh(const TetMesh& mesh, const std::filesystem::path& file, const MshOptions& options) {
  static WriteByGmsh* const write_by_gmsh = load_writer();
  OutputFile output(file);  // whose temporary name ends in ".msh", as Gmsh wants it
  std::string failure;
  write_by_gmsh(mesh, output.temporary_path(), options.version, failure);
  if (!failure.empty())
    throw IoError(
        {.what = "Gmsh cannot write the file", .where = file.string(), .value = failure, .limit = {}, .advice = {}});
  output.commit();
}

}  // namespace scan2fea
