// What a gate can name, and what the ready-made sets of gates hold a mesh to, made of report.schema.json and
// limits.hpp.
#pragma once

#include "quality/report.hpp"

#include <string>

namespace scan2fea {

// A line for each figure: its name, what it is in, and what it is. Ends with a line break.
std::string gate_list_table();

// {format, figures [{name, meaning, unit, yes_or_no}], sets [{name, gates [{name, operator, limit, of, source}]}]}; a
// unit of nothing is left out.
Json gate_list_json();

}  // namespace scan2fea
