// Request line and header fields, looked at strictly (RFC 9112) before anything else reads them.
//
// Whoever stands before us, a proxy say, may read a malformed head another way, and what it takes
// for a body we would take for a request. So whatever has two readings is refused, and the
// connection with it: names followed by blanks, folded lines, control characters, lengths that are
// no plain number, two framings, no host or two.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace symcell::server {

// What the server needs to know before it lets the request be parsed.
struct RequestHead {
  std::string method;
  std::string target;
  std::string host;  // lower case; empty only in HTTP/1.0
  bool is_http_1_0 = false;
  bool chunked = false;
  bool expects_continue = false;
  bool prefers_wait = false;  // Prefer: wait
  std::uint64_t content_length = 0;
  bool has_content_length = false;
  // Of Range, if it came. httplib refuses units that it does not know, which are to be ignored (RFC 9110,
  // 14.2), so it is not shown them: `range_lines` are their places, first byte and length.
  std::string range;
  std::vector<std::pair<std::size_t, std::size_t>> range_lines;
};

struct HeadFault {
  int status = 0;  // 0: none
  std::string detail;
};

// Takes the bytes of a head as they arrive.
class HeadReader {
 public:
  // Looks at what came since the last call; `bytes`: all that came since the request began.
  // True: nothing more is needed, the head is whole or faulty.
  [[nodiscard]] bool add(std::string_view bytes);

  [[nodiscard]] const HeadFault& fault() const { return fault_; }
  // Of a whole head without fault.
  [[nodiscard]] const RequestHead& head() const { return head_; }
  // Bytes up to and including the empty line.
  [[nodiscard]] std::size_t length() const { return length_; }

 private:
  bool refuse(int status, std::string detail);
  bool take_line(std::string_view line);
  bool take_request_line(std::string_view line);
  bool take_field(std::string_view line);
  bool take_framing(std::string_view name, std::string_view value);
  bool take_host(std::string_view value);
  bool finish();

  RequestHead head_;
  HeadFault fault_;
  std::size_t line_ = 0;     // where the line that is looked at begins
  std::size_t length_ = 0;   // bytes whose lines were taken
  std::size_t scanned_ = 0;  // bytes known to hold no end of the line that begins at length_
  std::size_t lines_ = 0;
  std::size_t hosts_ = 0;
  std::size_t codings_ = 0;
};

// Follows a chunked body on its way to httplib, which takes more for a chunk's length than the
// grammar does, and would wait for a body of a negative one. httplib knows no trailer fields: whoever reads takes
// what comes while in_trailer(), and hands on an empty line in its stead.
class ChunkGuard {
 public:
  // False: this is no chunked body; nothing after it can be understood.
  [[nodiscard]] bool pass(std::string_view bytes);
  // How many bytes may be passed at once, so that none of the trailer are.
  [[nodiscard]] std::size_t most() const;
  // The chunk of no bytes has come, the empty line after it not yet.
  [[nodiscard]] bool in_trailer() const { return state_ == State::kTrailer; }

 private:
  enum class State : std::uint8_t {
    kSizeStart,
    kSize,
    kExtension,
    kSizeEnd,  // the line feed of the length's line
    kData,
    kDataReturn,
    kDataEnd,
    kTrailer,  // the chunk of no bytes has come
    kOver,
  };

  [[nodiscard]] bool pass_size(char c);
  [[nodiscard]] bool pass_trailer(char c);

  State state_ = State::kSizeStart;
  std::uint64_t left_ = 0;  // of the chunk
  std::size_t digits_ = 0;
  std::size_t extension_ = 0;
  std::string field_;  // the line of the trailer that has begun
  std::size_t fields_ = 0;
  std::size_t trailer_bytes_ = 0;
};

}  // namespace symcell::server
