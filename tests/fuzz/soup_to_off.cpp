// soup_to_off INPUT OUT.off: the triangles that an input of the target `repair` describes.
#include "preproc/mesh/write_surface.hpp"
#include "tests/fuzz/soup_of_bytes.hpp"
#include "tests/temporary_folder.hpp"

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: soup_to_off INPUT OUT.off\n";
    return 2;
  }
  const std::string text = scan2fea::contents(argv[1]);
  scan2fea::fuzz::Bytes bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  std::cout << "option byte " << int(bytes.next()) << '\n';
  scan2fea::write_surface(scan2fea::fuzz::soup_of(bytes), argv[2]);
}
