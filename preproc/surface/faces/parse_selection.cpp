#include "preproc/mesh/error.hpp"
#include "preproc/mesh/length_unit.hpp"
#include "preproc/surface/faces/selection.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

namespace scan2fea {
namespace {

constexpr std::string_view plus_minus = "\u00b1";

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool is_word_part(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
}

// Recursive descent. Positions count from the expression's start.
class Parser {
 public:
  Parser(std::string_view text, std::string_view unit) : text_(text), unit_(unit) {}

  Selection whole() {
    Selection result = either();
    skip();
    if (at_ < text_.size()) fail("more follows than the expression", "and, or, or nothing");
    return result;
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& advice) const {
    throw WrongUsage({.what = what,
                      .where = "--set ..." + std::string(text_.substr(0, at_)) + " <- here",
                      .value = std::string(text_.substr(at_, 12)),
                      .limit = {},
                      .advice = advice});
  }

  void skip() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }
  bool take(std::string_view symbol) {
    skip();
    if (!text_.substr(at_).starts_with(symbol)) return false;
    at_ += symbol.size();
    return true;
  }
  void need(std::string_view symbol) {
    if (!take(symbol)) fail("'" + std::string(symbol) + "' is missing", "write " + std::string(symbol));
  }
  std::string_view peek_word() {
    skip();
    std::size_t end = at_;
    while (end < text_.size() && is_word_part(text_[end])) ++end;
    return text_.substr(at_, end - at_);
  }
  bool take_word(std::string_view word) {
    const std::string_view next = peek_word();
    if (lower(next) != word) return false;
    at_ += next.size();
    return true;
  }

  // The text from there to here.
  std::string since(std::size_t begin) const {
    std::string_view piece = text_.substr(begin, at_ - begin);
    while (!piece.empty() && std::isspace(static_cast<unsigned char>(piece.front())) != 0) piece.remove_prefix(1);
    return std::string(piece);
  }

  Selection joined(Selection::Kind kind, std::string_view word, Selection (Parser::*next)()) {
    const std::size_t begin = at_;
    Selection first = (this->*next)();
    if (lower(peek_word()) != word) return first;
    Selection all;
    all.kind = kind;
    all.operands.push_back(std::move(first));
    while (take_word(word)) all.operands.push_back((this->*next)());
    all.text = since(begin);
    return all;
  }
  Selection either() { return joined(Selection::Kind::either, "or", &Parser::both); }
  Selection both() { return joined(Selection::Kind::both, "and", &Parser::term); }

  // Each level is one more on the stack, and files of options have no limit of length.
  Selection nested(Selection (Parser::*next)()) {
    constexpr int deepest = 100;
    if (++depth_ > deepest) fail("more than 100 brackets or nots within one another", "fewer of them");
    Selection result = (this->*next)();
    --depth_;
    return result;
  }

  Selection term() {
    skip();
    const std::size_t begin = at_;
    if (take_word("not")) {
      Selection result;
      result.kind = Selection::Kind::inverse;
      result.operands.push_back(nested(&Parser::term));
      result.text = since(begin);
      return result;
    }
    if (take("(")) {
      Selection result = nested(&Parser::either);
      need(")");
      return result;
    }
    Selection result = atom();
    if (result.kind != Selection::Kind::name && result.kind != Selection::Kind::shape) result.text = since(begin);
    return result;
  }

  Selection atom() {
    const std::string_view word = peek_word();
    if (word.empty()) fail("an expression is missing", "FACE_1, plane(z<0.5), cylinder(r=5), box(...), ball(...)");
    const std::string name = lower(word);
    Selection result;
    if (const auto limit = try_limit()) {
      if (limit->of != Limit::Of::x && limit->of != Limit::Of::y && limit->of != Limit::Of::z)
        fail("only faces of a kind have a " + name, "cylinder(" + name + "...)");
      result.kind = Selection::Kind::half_space;
      result.limits.push_back(*limit);
      return result;
    }
    at_ += word.size();
    if (name == "box" || name == "ball" || name == "nearest") return region(name);
    if (name == "normal") {
      need("(");
      result.kind = Selection::Kind::normal;
      result.facing = direction();
      need(")");
      return result;
    }
    if (name == "largest") {
      need("(");
      result.kind = Selection::Kind::largest;
      result.operands.push_back(nested(&Parser::either));
      if (!result.operands[0].is_of_whole_faces())
        fail("largest takes faces, not what lies in a place", "largest(cylinder)");
      need(")");
      return result;
    }
    for (const std::string_view kind : {"plane", "cylinder", "cone", "sphere", "torus", "free"})
      if (name == kind) return shape(name);
    result.text = std::string(word);
    skip();
    if (at_ < text_.size() && text_[at_] == '(')
      fail("there is no '" + std::string(word) + "(...)'",
           "plane, cylinder, cone, sphere, torus, free, largest, nearest, box, ball, normal");
    return result;
  }

  Selection region(const std::string& name) {
    Selection result;
    need("(");
    const auto point = [&] {
      Vec3 p;
      for (int k = 0; k < 3; ++k) {
        p[k] = length();
        if (k < 2) need(",");
      }
      return p;
    };
    result.low = point();
    if (name == "nearest") {
      result.kind = Selection::Kind::nearest;
    } else if (take(",") || take(";")) {
      result.kind = name == "box" ? Selection::Kind::box : Selection::Kind::ball;
      if (name == "box") {
        const Vec3 other = point();
        result.high = result.low.cwiseMax(other);
        result.low = result.low.cwiseMin(other);
      } else {
        result.radius = length();
        if (!(result.radius > 0)) fail("the radius must be above 0", "ball(x, y, z, radius)");
      }
    } else {
      fail("numbers are missing", name == "box" ? "box(x,y,z, x,y,z)" : "ball(x, y, z, radius)");
    }
    need(")");
    return result;
  }

  Selection shape(const std::string& name) {
    Selection result;
    result.kind = Selection::Kind::shape;
    result.text = name;
    if (!take("(")) return result;
    if (take(")")) return result;
    do {
      if (take_word("hole"))
        result.hollow = true;
      else if (take_word("boss"))
        result.hollow = false;
      else if (!take_limits(result.limits))
        result.facing = direction();
    } while (take(","));
    need(")");
    return result;
  }

  std::optional<Limit::Of> measure(std::string_view word) const {
    constexpr std::array<std::pair<std::string_view, Limit::Of>, 7> all{{{"x", Limit::Of::x},
                                                                         {"y", Limit::Of::y},
                                                                         {"z", Limit::Of::z},
                                                                         {"r", Limit::Of::radius},
                                                                         {"radius", Limit::Of::radius},
                                                                         {"tube", Limit::Of::tube},
                                                                         {"area", Limit::Of::area}}};
    for (const auto& [name, of] : all)
      if (name == word) return of;
    return {};
  }

  // "z<0.5"; nothing, and nothing taken, where it is something else.
  std::optional<Limit> try_limit() {
    const std::size_t begin = at_;
    const std::string_view word = peek_word();
    const auto of = measure(lower(word));
    if (!of) return {};
    at_ += word.size();
    const bool below = take("<");
    if (!below && !take(">")) {
      at_ = begin;
      return {};
    }
    take("=");
    return Limit{*of, !below, *of == Limit::Of::area ? number() : length()};
  }

  bool take_limits(std::vector<Limit>& limits) {
    if (const auto limit = try_limit()) {
      limits.push_back(*limit);
      return true;
    }
    const std::size_t begin = at_;
    const std::string_view word = peek_word();
    const auto of = measure(lower(word));
    if (!of) return false;
    at_ += word.size();
    if (!take("=")) {
      at_ = begin;  // a direction
      return false;
    }
    constexpr double usual = 0.02;
    const double value = length();
    const double tolerance = take(plus_minus) || take("+-") || take("+/-") ? length() : usual * std::abs(value);
    limits.push_back({*of, true, value - tolerance});
    limits.push_back({*of, false, value + tolerance});
    return true;
  }

  Direction direction() {
    Direction result;
    if (take_word("axis")) need("=");
    const bool opposite = [&] {
      const std::size_t begin = at_;
      if (!take("-")) return false;
      const std::string axis = lower(peek_word());
      if (axis == "x" || axis == "y" || axis == "z") return true;
      at_ = begin;
      return false;
    }();
    if (take_word("x")) {
      result.vector = Vec3::UnitX();
    } else if (take_word("y")) {
      result.vector = Vec3::UnitY();
    } else if (!take_word("z")) {
      const bool in_brackets = take("(");
      for (int k = 0; k < 3; ++k) {
        result.vector[k] = number();
        if (k < 2) need(",");
      }
      if (in_brackets) need(")");
      if (!(result.vector.norm() > 0)) fail("a direction has a length", "0,0,1");
      result.vector.normalize();
    }
    if (opposite) result.vector = -result.vector;
    if (take(";")) {
      result.within_deg = number();
      take_word("deg");
      if (!(result.within_deg > 0 && result.within_deg < 180)) fail("the angle must be above 0 and below 180", "15deg");
    }
    return result;
  }

  double number() {
    skip();
    double value = 0;
    const char* begin = text_.data() + at_;
    const char* end = text_.data() + text_.size();
    if (begin < end && *begin == '+') ++begin;
    const auto [next, error] = std::from_chars(begin, end, value);
    if (error != std::errc{} || !std::isfinite(value)) fail("a number is missing", "0.5");
    at_ = static_cast<std::size_t>(next - text_.data());
    return value;
  }

  // A number that may have a unit.
  double length() {
    const double value = number();
    const std::string_view word = peek_word();
    // The short names alone: a longer word is one of the expression.
    const std::string own = lower(word), model = lower(unit_);
    if (length_unit(own) != own) return value;
    if (length_unit(model) != model) fail("a length has a unit, and the scan has none", "--unit mm");
    at_ += word.size();
    return value * metres(own) / metres(model);
  }

  std::string_view text_, unit_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

void check_name(const std::string& name) {
  // Solvers take 80 characters, and writers add to a name what they derive from it.
  constexpr std::size_t longest = 64;
  const bool is_word = !name.empty() && name.size() <= longest && std::isalpha(static_cast<unsigned char>(name[0])) &&
                       std::all_of(name.begin(), name.end(),
                                   [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
  if (!is_word)
    throw WrongUsage({.what = "not the name of a set",
                      .where = "--set",
                      .value = name,
                      .limit = "a letter, then letters, digits, _ and -, 64 in all",
                      .advice = "--set \"fixed=FACE_3\""});
  for (const std::string_view taken : {"nall", "eall", "sall", "sall_nodes", "filled", "enriched"})
    if (lower(name) == taken)
      throw WrongUsage({.what = "every file has a set of this name already",
                        .where = "--set",
                        .value = name,
                        .limit = {},
                        .advice = "another name"});
}

}  // namespace

bool Selection::is_of_whole_faces() const {
  switch (kind) {
    case Kind::name:
    case Kind::shape:
    case Kind::largest:
    case Kind::nearest:
      return true;
    case Kind::both:
    case Kind::either:
    case Kind::inverse:
      return std::all_of(operands.begin(), operands.end(), [](const Selection& s) { return s.is_of_whole_faces(); });
    default:
      return false;
  }
}

NamedSelection parse_selection(std::string_view text, std::string_view unit) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos)
    throw WrongUsage({.what = "a set is NAME=EXPRESSION",
                      .where = "--set",
                      .value = std::string(text),
                      .limit = {},
                      .advice = "--set \"fixed=FACE_3\""});
  std::string name(text.substr(0, equals));
  while (!name.empty() && name.back() == ' ') name.pop_back();
  check_name(name);
  return {std::move(name), Parser(text.substr(equals + 1), unit).whole()};
}

}  // namespace scan2fea
