// What gzip compressed, and what deflate did within another file.
#pragma once

#include <memory>
#include <span>
#include <string_view>

namespace scan2fea::gzip {

enum class Wrapping { gzip, none };

// Gives the bytes that were compressed, piece by piece. Precondition: `bytes` outlive it.
class Expander {
 public:
  explicit Expander(std::string_view bytes, Wrapping wrapping = Wrapping::gzip);
  ~Expander();
  Expander(const Expander&) = delete;
  Expander& operator=(const Expander&) = delete;

  // The next ones, as many as there is room for or fewer; how many.
  std::size_t read(std::span<char> room);
  bool is_at_end() const;
  bool is_broken() const;  // or cut short

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace scan2fea::gzip
