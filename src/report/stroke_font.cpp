// SPDX-License-Identifier: Apache-2.0
// SPDX-FileCopyrightText: 2026 The dermis authors
#include <algorithm>
#include <array>
#include <string>

#include "report/raster.hpp"

namespace dermis::report {
namespace {

/// A letter as lines between points of two digits, x and y. Capitals stand between y = 0 and the base line at y = 6,
/// small letters begin at y = 2, tails end at y = 8. Lines are parted by blanks.
struct Glyph {
  char letter;
  std::string_view lines;
};

constexpr std::array<Glyph, 78> kGlyphs{{
    {'0', "103041453616050110"},
    {'1', "012026"},
    {'2', "01103041420646"},
    {'3', "0110304142334445361605 1333"},
    {'4', "36300444"},
    {'5', "400003334445361605"},
    {'6', "413010010516364544331304"},
    {'7', "004016"},
    {'8', "103041423313020110 1304051636454433"},
    {'9', "051636454130100102133342"},
    {'A', "062046 1434"},
    {'B', "06003041423344453606 0333"},
    {'C', "4130100105163645"},
    {'D', "060030414536 0636"},
    {'E', "40000646 0333"},
    {'F', "400006 0333"},
    {'G', "41301001051636454323"},
    {'H', "0006 4046 0343"},
    {'I', "0006"},
    {'J', "4045361605"},
    {'K', "0006 400346"},
    {'L', "000646"},
    {'M', "0600234046"},
    {'N', "06004640"},
    {'O', "103041453616050110"},
    {'P', "06003041423303"},
    {'Q', "103041453616050110 3446"},
    {'R', "06003041423303 2346"},
    {'S', "413010010213334445361605"},
    {'T', "0040 2026"},
    {'U', "000516364540"},
    {'V', "002640"},
    {'W', "0016233640"},
    {'X', "0046 4006"},
    {'Y', "002340 2326"},
    {'Z', "00400646"},
    {'a', "12324346 441405163645"},
    {'b', "0006 0312324345361605"},
    {'c', "4332120305163645"},
    {'d', "4046 4332120305163645"},
    {'e', "04444332120305163645"},
    {'f', "30201116 0222"},
    {'g', "4332120305163645 4247381807"},
    {'h', "0006 0312324346"},
    {'i', "0206 0000"},
    {'j', "12171808 1010"},
    {'k', "0006 320446"},
    {'l', "000516"},
    {'m', "0206 03122326 23324346"},
    {'n', "0206 0312324346"},
    {'o', "123243453616050312"},
    {'p', "0208 0312324345361605"},
    {'q', "4248 4332120305163645"},
    {'r', "0206 031222"},
    {'s', "43321203143445361605"},
    {'t', "10151626 0222"},
    {'u', "0205163645 4246"},
    {'v', "022642"},
    {'w', "0216233642"},
    {'x', "0246 4206"},
    {'y', "0226 4208"},
    {'z', "02420646"},
    {'.', "0606"},
    {',', "0607"},
    {':', "0303 0606"},
    {'-', "0333"},
    {'+', "0444 2226"},
    {'=', "0242 0545"},
    {'/', "0640"},
    {'#', "1016 3036 0242 0444"},
    {'(', "20111526"},
    {')', "00111506"},
    {'_', "0747"},
    {'%', "0640 0000 4646"},
    {'!', "0004 0606"},
    {'\'', "0001"},
    {'<', "410345"},
    {'>', "014305"},
}};

constexpr std::string_view kUnknown = "0040460600";
constexpr double kCapital = 6.0;
constexpr double kGap = 2.0;
constexpr double kBlank = 2.0;

std::string_view lines_of(char letter) {
  const auto* const found =
      std::find_if(kGlyphs.begin(), kGlyphs.end(), [&](const Glyph& glyph) { return glyph.letter == letter; });
  return found == kGlyphs.end() ? kUnknown : found->lines;
}

/// In the grid of the letter.
double width_of(char letter) {
  if (letter == ' ') return kBlank;
  double width = 0.0;
  bool is_x = true;
  for (const char digit : lines_of(letter)) {
    if (digit == ' ') continue;
    if (is_x) width = std::max(width, static_cast<double>(digit - '0'));
    is_x = !is_x;
  }
  return width;
}

/// One letter stands for all bytes of a character in UTF-8.
bool is_continuation(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
}

void append_letter(char letter, Point corner, double unit, std::vector<std::vector<Point>>& strokes) {
  strokes.emplace_back();
  const std::string_view lines = lines_of(letter);
  for (std::size_t i = 0; i + 1 < lines.size();) {
    if (lines[i] == ' ') {
      strokes.emplace_back();
      ++i;
      continue;
    }
    const Point point{static_cast<double>(lines[i] - '0'), static_cast<double>(lines[i + 1] - '0') - kCapital};
    strokes.back().push_back({corner.x + unit * point.x, corner.y + unit * point.y});
    i += 2;
  }
}

}  // namespace

std::vector<std::vector<Point>> text_strokes(std::string_view text, Point place, double size) {
  const double unit = size / kCapital;
  std::vector<std::vector<Point>> strokes;
  for (const char letter : text) {
    if (is_continuation(letter)) continue;
    if (letter != ' ') append_letter(letter, place, unit, strokes);
    place.x += unit * (width_of(letter) + kGap);
  }
  return strokes;
}

double stroke_text_width(std::string_view text, double size) {
  double width = 0.0;
  for (const char letter : text) {
    if (!is_continuation(letter)) width += width_of(letter) + kGap;
  }
  return std::max(width - kGap, 0.0) * size / kCapital;
}

}  // namespace dermis::report
