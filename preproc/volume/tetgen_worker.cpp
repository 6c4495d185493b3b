// scan2fea-tetgen INPUT OUTPUT MEMORY_BYTES PARENT: one call of TetGen in a process of its own.
//
// TetGen may crash, exit, throw an int, loop or ask for all memory, according to its input; here that hurts nobody. The
// exit status tells what happened (TetgenStatus). The only file that includes tetgen.h.
#include "preproc/volume/tetgen_exchange.hpp"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <dlfcn.h>
#include <exception>
#include <new>
#include <string>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <typeinfo>
#include <unistd.h>

#define TETLIBRARY
#include <tetgen.h>

namespace {

using scan2fea::TetgenInput;
using scan2fea::TetgenOutput;
using scan2fea::TetgenStatus;

// Facets point into arrays that outlive the call; tetgenio's destructor must not delete them.
class Facets {
 public:
  explicit Facets(const TetgenInput& input)
      : corners_(input.triangles.size() * 3),
        polygons_(input.triangles.size()),
        facets_(input.triangles.size()),
        markers_(input.triangles.size()) {
    for (std::size_t t = 0; t < input.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) corners_[3 * t + k] = static_cast<int>(input.triangles[t][k]);
      tetgenio::init(&polygons_[t]);
      polygons_[t].vertexlist = &corners_[3 * t];
      polygons_[t].numberofvertices = 3;
      tetgenio::init(&facets_[t]);
      facets_[t].polygonlist = &polygons_[t];
      facets_[t].numberofpolygons = 1;
      markers_[t] = static_cast<int>(t) + 1;
    }
  }

  void lend(tetgenio& io) {
    io.facetlist = facets_.data();
    io.facetmarkerlist = markers_.data();
    io.numberoffacets = static_cast<int>(facets_.size());
  }
  static void take_back(tetgenio& io) {
    io.facetlist = nullptr;
    io.facetmarkerlist = nullptr;
    io.numberoffacets = 0;
  }

 private:
  std::vector<int> corners_;
  std::vector<tetgenio::polygon> polygons_;
  std::vector<tetgenio::facet> facets_;
  std::vector<int> markers_;
};

TetgenOutput run(TetgenInput& input) {
  tetgenio in, out;
  in.firstnumber = 0;
  in.pointlist = input.points.front().data();
  in.numberofpoints = static_cast<int>(input.points.size());
  Facets facets(input);
  facets.lend(in);
  tetrahedralize(input.switches.data(), &in, &out);
  in.pointlist = nullptr;
  Facets::take_back(in);

  TetgenOutput output;
  output.points.reserve(static_cast<std::size_t>(out.numberofpoints));
  for (int i = 0; i < out.numberofpoints; ++i)
    output.points.emplace_back(out.pointlist[3 * i], out.pointlist[3 * i + 1], out.pointlist[3 * i + 2]);
  const auto node = [](int i) { return static_cast<std::uint32_t>(i); };
  output.tetrahedra.reserve(static_cast<std::size_t>(out.numberoftetrahedra));
  for (int i = 0; i < out.numberoftetrahedra; ++i) {
    const int* corner = out.tetrahedronlist + out.numberofcorners * i;
    output.tetrahedra.push_back({node(corner[0]), node(corner[1]), node(corner[2]), node(corner[3])});
  }
  output.faces.reserve(static_cast<std::size_t>(out.numberoftrifaces));
  for (int i = 0; i < out.numberoftrifaces; ++i) {
    const int* corner = out.trifacelist + 3 * i;
    output.faces.push_back({node(corner[0]), node(corner[1]), node(corner[2])});
    output.face_marker.push_back(out.trifacemarkerlist ? node(out.trifacemarkerlist[i]) : 0);
  }
  return output;
}

TetgenStatus status_of(int thrown) {
  switch (thrown) {
    case 1:
      return TetgenStatus::out_of_memory;
    case 3:
      return TetgenStatus::self_intersection;
    case 4:
      return TetgenStatus::tiny_feature;
    case 5:
      return TetgenStatus::close_facets;
    case 10:
      return TetgenStatus::wrong_input;
    default:
      return TetgenStatus::internal_error;
  }
}

[[noreturn]] void leave(TetgenStatus status) {
  std::_Exit(static_cast<int>(status));
}

}  // namespace

// TetGen reports an error by throwing an int; the stack unwinds through its destructor, which frees a second time what
// was freed before the throw, and aborts. So the process leaves at the throw itself. (An executable's own definition
// comes before the runtime library's.)
extern "C" [[noreturn]] void __cxa_throw(void* thrown, void* type, void (*destroy)(void*)) {
  if (*static_cast<std::type_info*>(type) == typeid(int)) leave(status_of(*static_cast<int*>(thrown)));
  using Throw = void (*)(void*, void*, void (*)(void*));
  reinterpret_cast<Throw>(dlsym(RTLD_NEXT, "__cxa_throw"))(thrown, type, destroy);
  std::abort();
}

int main(int argc, char** argv) {
  if (argc != 5) return static_cast<int>(TetgenStatus::wrong_input);
  // Whoever kills the command kills its worker too, also where that was before this line.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (std::to_string(getppid()) != argv[4]) leave(TetgenStatus::internal_error);
  // What passes a limit on the size of files is an error like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  // No core files of a crash that the command reports.
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  if (const rlim_t bytes = std::strtoull(argv[3], nullptr, 10); bytes > 0) {
    const rlimit memory{bytes, bytes};
    setrlimit(RLIMIT_AS, &memory);
  }
  std::set_new_handler([] { leave(TetgenStatus::out_of_memory); });
  try {
    TetgenInput input = scan2fea::read_tetgen_input(argv[1]);
    scan2fea::write_exchange(run(input), argv[2]);
  } catch (const std::exception&) {
    leave(TetgenStatus::file_error);
  }
  leave(TetgenStatus::success);
}
