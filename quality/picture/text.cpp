#include "quality/picture/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ft2build.h>
#include FT_FREETYPE_H

// The assembler takes the font in as it is.
asm(".section .rodata\n"
    ".global scan2fea_picture_font\n"
    ".hidden scan2fea_picture_font\n"
    "scan2fea_picture_font:\n"
    ".incbin \"" SCAN2FEA_PICTURE_FONT
    "\"\n"
    ".global scan2fea_picture_font_end\n"
    ".hidden scan2fea_picture_font_end\n"
    "scan2fea_picture_font_end:\n"
    ".byte 0\n"
    ".previous\n");
extern "C" const unsigned char scan2fea_picture_font[], scan2fea_picture_font_end[];

namespace scan2fea {
namespace {

// FreeType's objects, which are not for two threads at once: each text has its own, which takes 0.1 ms.
class Font {
 public:
  explicit Font(double size) {
    if (FT_Init_FreeType(&library_) != 0) return;
    if (FT_New_Memory_Face(library_, scan2fea_picture_font, scan2fea_picture_font_end - scan2fea_picture_font, 0,
                           &face_) != 0)
      return;
    constexpr double unit = 64;  // FreeType counts in 64ths of a pixel
    FT_Set_Char_Size(face_, 0, std::lround(unit * size), 72, 72);
  }
  ~Font() {
    if (face_ != nullptr) FT_Done_Face(face_);
    if (library_ != nullptr) FT_Done_FreeType(library_);
  }
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  // Null where memory is short. Without hinting, so that widths are proportional to the size.
  FT_GlyphSlot glyph(char32_t letter, bool drawn) const {
    const FT_Int32 flags = FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP | (drawn ? FT_LOAD_RENDER : 0);
    return face_ != nullptr && FT_Load_Char(face_, letter, flags) == 0 ? face_->glyph : nullptr;
  }

 private:
  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
};

// Takes one letter off the text; a byte that begins none is U+FFFD.
char32_t next_letter(std::string_view& text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t length = first < 0x80 ? 1 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : 0;
  char32_t letter = length == 1 ? first : first & (0xffU >> (length + 1));
  bool is_whole = length > 0 && length <= text.size();
  for (std::size_t i = 1; is_whole && i < length; ++i) {
    is_whole = (text[i] & 0xc0) == 0x80;
    letter = letter << 6 | (text[i] & 0x3f);
  }
  text.remove_prefix(is_whole ? length : 1);
  return is_whole ? letter : 0xfffd;
}

void blend(std::uint8_t* pixel, const Rgb& ink, unsigned cover) {
  const unsigned below = pixel[3] * (255 - cover) / 255, sum = cover + below;
  if (sum == 0) return;
  for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>((ink[c] * cover + pixel[c] * below) / sum);
  pixel[3] = static_cast<std::uint8_t>(sum);
}

}  // namespace

double text_width(std::string_view text, double size) {
  const Font font(size);
  double width = 0;
  while (!text.empty())
    if (const FT_GlyphSlot glyph = font.glyph(next_letter(text), false))
      width += static_cast<double>(glyph->linearHoriAdvance) / 65536;
  return width;
}

void draw_text(Raster& raster, std::string_view text, double x, double y, double size, const Rgb& ink) {
  const Font font(size);
  while (!text.empty()) {
    const FT_GlyphSlot glyph = font.glyph(next_letter(text), true);
    if (glyph == nullptr) continue;
    const long left = std::lround(x) + glyph->bitmap_left, top = std::lround(y) - glyph->bitmap_top;
    for (unsigned row = 0; row < glyph->bitmap.rows; ++row)
      for (unsigned column = 0; column < glyph->bitmap.width; ++column) {
        const long at_x = left + column, at_y = top + row;
        if (at_x < 0 || at_y < 0 || at_x >= raster.width || at_y >= raster.height) continue;
        blend(raster.pixel(static_cast<std::uint32_t>(at_x), static_cast<std::uint32_t>(at_y)), ink,
              glyph->bitmap.buffer[static_cast<std::ptrdiff_t>(row) * glyph->bitmap.pitch + column]);
      }
    x += static_cast<double>(glyph->linearHoriAdvance) / 65536;
  }
}

}  // namespace scan2fea
