// Numbers in the form that fixed-width readers take.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace scan2fea {

// CalculiX reads this many characters of a number.
inline constexpr std::size_t longest_number = 20;

// Writes `value` to `text` (room for `longest_number` characters, no terminator) and returns the end: the shortest
// form that reads back to the same bits or, where that is longer than `longest_number`, the form with the most
// significant digits that fits: at least 15 from 1e-9 to 1e18, at least 13 elsewhere.
// Precondition: `value` is finite.
char* write_number(char* text, double value);

// Nastran's large field.
inline constexpr std::size_t nastran_width = 16;

// Likewise for Nastran, with room for `nastran_width` characters: a decimal point always, and an exponent without its
// letter ("1.5-3"): the form with the most significant digits that fits, at least 11, or the shortest that reads back
// to the same bits.
char* write_nastran_number(char* text, double value);

// Of these, and of Fortran's, whose exponents may begin with a D or have no letter: nothing where it is no number.
std::optional<double> read_number(std::string_view text);

// What a reader of these finds. Not finite values stay.
double as_written(double value);
double as_written_for_nastran(double value);

}  // namespace scan2fea
