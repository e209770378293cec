// The text part of Canvas.
#include <algorithm>

#include "src/image_file/drawing.hpp"
#include "src/image_file/font.hpp"

namespace gannet::image_file {

TextSize text_size(std::string_view utf8, int scale) {
  int lines = 1, column = 0, widest = 0;
  while (!utf8.empty()) {
    const bool new_line = next_letter(utf8) == U'\n';
    column = new_line ? 0 : column + 1;
    lines += new_line ? 1 : 0;
    widest = std::max(widest, column);
  }
  return {widest * kCellWidth * scale, lines * kCellHeight * scale};
}

void Canvas::text(int x, int y, std::string_view utf8, Colour colour, int scale) {
  int left = x, top = y;
  const auto square = [&](int column, int row) {
    for (int dy = 0; dy < scale; ++dy)
      for (int dx = 0; dx < scale; ++dx) {
        const int px = left + column * scale + dx, py = top + row * scale + dy;
        if (px >= 0 && py >= 0 && px < image_.width() && py < image_.height())
          blend(px, py, colour, 1);
      }
  };
  while (!utf8.empty()) {
    const char32_t letter = next_letter(utf8);
    if (letter == U'\n') {
      left = x;
      top += kCellHeight * scale;
      continue;
    }
    for (int row = 0; row < kGlyphRows; ++row)
      for (int column = 0; column < kGlyphWidth; ++column)
        if (glyph_dot(letter, column, row)) square(column, row);
    left += kCellWidth * scale;
  }
}

void Canvas::label(int x, int y, std::string_view utf8, Colour colour, int scale) {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) text(x + dx, y + dy, utf8, colours::kBlack, scale);
  text(x, y, utf8, colour, scale);
}

}  // namespace gannet::image_file
