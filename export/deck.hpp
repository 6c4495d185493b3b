// Decks that run as they are and that the user edits: a static analysis or natural frequencies of a part of steel that
// is clamped at its set `fixed` and pressed at its set `loaded`, for CalculiX and Abaqus (.inp) or Code_Aster (.comm).
//
// A deck stands beside the file of the mesh: it includes the .inp, or reads the .med or .mail. Its units are the
// consistent ones of the mesh's unit of length: mm, N, t, MPa; m, N, kg, Pa; um, uN, kg, MPa; cm, dyn, g, dyn/cm2;
// in, lbf, lbf s2/in, psi; ft, lbf, slug, psf. What is assumed (material, what `fixed` holds, the pressure, how many
// modes) stands in lines that begin with ASSUMED and tell how to change it. Each body has a section of its own.
#pragma once

#include "export/mesh_file.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace scan2fea {

enum class DeckKind { static_analysis, modal };

// "part_static.inp" beside "part.inp", "part_modal.comm" beside "part.med". Throws WrongUsage where there are no decks
// for the format of the mesh, or where CalculiX cannot include a file of this name.
std::filesystem::path deck_file(const std::filesystem::path& mesh_file, DeckKind kind);

// The sets that a deck of this kind needs: "fixed", and for a static analysis "loaded"; upper or lower case.
std::span<const std::string_view> sets_of_deck(DeckKind kind);

// Throws WrongUsage where the mesh has no unit of length, or where a set that is needed is missing, empty, or of nodes
// though it is pressed; and for what `deck_file` does. `options`: those of the
// mesh's file, for the prefix of its sets and its numbers. Sets of elements are bodies where they do not overlap.
std::string deck_text(const TetMesh& mesh, const std::filesystem::path& mesh_file, DeckKind kind,
                      const FileOptions& options = {});

}  // namespace scan2fea
