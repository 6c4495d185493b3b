// Jobs that this machine cannot hold are refused before they start, and not after minutes in which memory fills.
#pragma once

#include <string>

namespace scan2fea {

// Throws NotMeshable where so many elements with so many bytes each are more than the process may have: the machine's
// memory, or its own limit (ulimit -v). `elements` is their name, "tetrahedra"; `advice` what to try. Not guaranteed:
// that what passes ends well, since other programs run, too.
void require_memory(double count, double bytes_each, const std::string& elements, const std::string& advice);

}  // namespace scan2fea
