// The files that this library starts or loads at run time instead of linking them: TetGen's worker and MED's module.
#pragma once

#include <filesystem>
#include <string_view>

namespace scan2fea {

// The path of a companion, found from the place of the file that holds this function's code (an executable, or
// libscan2fea.so or the Python module in any program), since an install folder may have been moved: beside that file,
// as in the build folder, or in the installation's folder of companions, lib/scan2fea. Where there is none, the path
// that it would have beside that file, so that the attempt to use it fails with a place in its message.
std::filesystem::path companion_file(std::string_view name);

}  // namespace scan2fea
