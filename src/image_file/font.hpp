// A small bitmap font of our own: ASCII and some signs of measurement, five dots wide, seven high
// and two below the line, in a cell of 6 × 10. Any thread.
#pragma once

#include <string_view>

namespace gannet::image_file {

inline constexpr int kGlyphWidth = 5, kGlyphRows = 9, kCellWidth = 6, kCellHeight = 10;

// Whether the dot of a letter's glyph is set; column 0 … 4, row 0 … 8. A letter that is not in the
// font is a box.
bool glyph_dot(char32_t letter, int column, int row);

// Takes the first letter off a UTF-8 text; a byte that is no UTF-8 counts as U+FFFD.
char32_t next_letter(std::string_view& utf8);

}  // namespace gannet::image_file
