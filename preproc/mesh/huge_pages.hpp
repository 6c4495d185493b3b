// How this program and its children ask the C library for memory.
#pragma once

namespace scan2fea {

// Arrays that are filled and freed again soon, and TetGen's pools, which grow by small pieces: taken as huge pages and
// in advance, they cost a fifth to a third less time. Read from the environment at the start of a process only. Larger
// steps than 32 MiB gain nothing, and a child with a limit of memory runs into it.
inline constexpr const char* allocator_variable = "GLIBC_TUNABLES";
inline constexpr const char* allocator_setting = "glibc.malloc.hugetlb=1:glibc.malloc.top_pad=33554432";

}  // namespace scan2fea
