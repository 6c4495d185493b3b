#include "preproc/mesh/gzip.hpp"

#include <algorithm>
#include <limits>
#include <zlib.h>

namespace scan2fea::gzip {

struct Expander::State {
  std::string_view rest;
  z_stream stream{};
  bool at_end = false, broken = false;
};

// To zlib 16 means with gzip's head and checksum, a negative number without any.
Expander::Expander(std::string_view bytes, Wrapping wrapping) : state_(std::make_unique<State>()) {
  state_->rest = bytes;
  state_->broken = inflateInit2(&state_->stream, wrapping == Wrapping::gzip ? 16 + MAX_WBITS : -MAX_WBITS) != Z_OK;
}

Expander::~Expander() {
  inflateEnd(&state_->stream);
}

std::size_t Expander::read(std::span<char> room) {
  State& state = *state_;
  if (state.at_end || state.broken || room.empty()) return 0;
  constexpr std::size_t most = std::numeric_limits<uInt>::max();  // zlib counts in 32 bits
  const auto given = static_cast<uInt>(std::min(state.rest.size(), most));
  const auto wanted = static_cast<uInt>(std::min(room.size(), most));
  state.stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(state.rest.data()));
  state.stream.avail_in = given;
  state.stream.next_out = reinterpret_cast<Bytef*>(room.data());
  state.stream.avail_out = wanted;
  const int result = inflate(&state.stream, Z_NO_FLUSH);
  const std::size_t made = wanted - state.stream.avail_out;
  state.rest.remove_prefix(given - state.stream.avail_in);
  if (result == Z_STREAM_END) {
    // Another member may follow; what is no member, as zeros of a tape, is passed over, as gzip does.
    state.at_end = !state.rest.starts_with("\x1f\x8b");
    if (!state.at_end) state.broken = inflateReset(&state.stream) != Z_OK;
  } else if (result != Z_OK || (made == 0 && state.rest.empty())) {
    state.broken = true;
  }
  return made;
}

bool Expander::is_at_end() const {
  return state_->at_end;
}

bool Expander::is_broken() const {
  return state_->broken;
}

}  // namespace scan2fea::gzip
