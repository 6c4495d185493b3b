#include "quality/picture/text.hpp"

#include "preproc/mesh/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <dlfcn.h>
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

constexpr const char* free_type_library = "libfreetype.so.6";

// FreeType's functions, loaded with the first text: to load it with the program takes some ms of every run.
struct FreeType {
  decltype(&FT_Init_FreeType) begin;
  decltype(&FT_Done_FreeType) end;
  decltype(&FT_New_Memory_Face) new_face;
  decltype(&FT_Done_Face) end_face;
  decltype(&FT_Set_Char_Size) set_size;
  decltype(&FT_Load_Char) load_letter;
};

template <class Function>
Function* function_of(void* library, const char* name) {
  void* function = library != nullptr ? ::dlsym(library, name) : nullptr;
  if (function != nullptr) return reinterpret_cast<Function*>(function);
  const char* reason = ::dlerror();
  throw IoError({.what = "the text of a picture cannot be drawn: FreeType does not load",
                 .where = free_type_library,
                 .value = reason != nullptr ? reason : "",
                 .limit = {},
                 .advice = "apt-get install libfreetype6, or --colour none"});
}

const FreeType& free_type() {
  static const FreeType functions = [] {
    void* library = ::dlopen(free_type_library, RTLD_NOW | RTLD_LOCAL);
    return FreeType{.begin = function_of<decltype(FT_Init_FreeType)>(library, "FT_Init_FreeType"),
                    .end = function_of<decltype(FT_Done_FreeType)>(library, "FT_Done_FreeType"),
                    .new_face = function_of<decltype(FT_New_Memory_Face)>(library, "FT_New_Memory_Face"),
                    .end_face = function_of<decltype(FT_Done_Face)>(library, "FT_Done_Face"),
                    .set_size = function_of<decltype(FT_Set_Char_Size)>(library, "FT_Set_Char_Size"),
                    .load_letter = function_of<decltype(FT_Load_Char)>(library, "FT_Load_Char")};
  }();
  return functions;
}

// FreeType's objects, which are not for two threads at once: each text has its own, which takes 0.1 ms.
class Font {
 public:
  explicit Font(double size) {
    if (free_type().begin(&library_) != 0) return;
    if (free_type().new_face(library_, scan2fea_picture_font, scan2fea_picture_font_end - scan2fea_picture_font, 0,
                             &face_) != 0)
      return;
    constexpr double unit = 64;  // FreeType counts in 64ths of a pixel
    free_type().set_size(face_, 0, std::lround(unit * size), 72, 72);
  }
  ~Font() {
    if (face_ != nullptr) free_type().end_face(face_);
    if (library_ != nullptr) free_type().end(library_);
  }
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  // Null where memory is short. Without hinting, so that widths are proportional to the size.
  FT_GlyphSlot glyph(char32_t letter, bool drawn) const {
    const FT_Int32 flags = FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP | (drawn ? FT_LOAD_RENDER : 0);
    return face_ != nullptr && free_type().load_letter(face_, letter, flags) == 0 ? face_->glyph : nullptr;
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
