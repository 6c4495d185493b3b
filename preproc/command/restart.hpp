// The program started anew with memory in huge pages (see preproc/mesh/huge_pages.hpp).
#pragma once

namespace scan2fea::command {

// The same process, 2 ms later. Does nothing where the C library is told otherwise already, or where it cannot be.
// `argv`: of main. To be called first of all.
void restart_with_huge_pages(char** argv);

}  // namespace scan2fea::command
