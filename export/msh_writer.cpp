#include "export/gmsh_module.hpp"
#include "export/msh.hpp"
#include "preproc/mesh/companion_file.hpp"
#include "preproc/mesh/error.hpp"
#include "preproc/mesh/output_file.hpp"
#include "preproc/mesh/temporary_folder.hpp"

#include <dlfcn.h>
#include <system_error>

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

// Another name of the file, ending in ".msh".
fs::path link_for_gmsh(const fs::path& file, const TemporaryFolder& folder) {
  fs::path link = folder / "mesh.msh";
  std::error_code error;
  fs::create_symlink(fs::absolute(file), link, error);
  if (error)
    throw IoError({.what = "cannot make a link to the output",
                   .where = link.string(),
                   .value = error.message(),
                   .limit = {},
                   .advice = "set TMPDIR to a folder that can hold symbolic links"});
  return link;
}

}  // namespace

void write_msh(const TetMesh& mesh, const std::filesystem::path& file, const MshOptions& options) {
  static WriteByGmsh* const write_by_gmsh = load_writer();
  OutputFile output(file);
  const TemporaryFolder folder;
  std::string failure;
  write_by_gmsh(mesh, link_for_gmsh(output.temporary_path(), folder), options.version, failure);
  if (!failure.empty())
    throw IoError(
        {.what = "Gmsh cannot write the file", .where = file.string(), .value = failure, .limit = {}, .advice = {}});
  output.commit();
}

}  // namespace scan2fea
