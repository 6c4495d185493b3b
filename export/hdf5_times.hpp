// What the HDF5 library writes of the clock: files of one mesh would differ by it.
#pragma once

#include <string>

namespace scan2fea {

// Sets the times of access, change and birth of all objects in the bytes of an HDF5 file to 0, which readers take for
// not known, and the checksums to what is there then. Source: HDF5 File Format Specification 3.0, IV.A.1.b, "Version 2
// Data Object Header Prefix"; objects of version 1, which MED's library does not write, keep theirs.
void forget_times(std::string& hdf5);

}  // namespace scan2fea
