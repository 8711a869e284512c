#include "server/http/request_head.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

namespace symcell::server {
namespace {

constexpr std::size_t kMaxTargetBytes = 8192;
constexpr std::size_t kShownMethod = 40;  // bytes of one in messages
// httplib reads no more of them, and nobody sends a tenth.
constexpr std::size_t kMaxLines = 500;
// Of a number of bytes: more than any disk holds.
constexpr std::size_t kMaxLengthDigits = 15;
constexpr std::size_t kMaxChunkDigits = 12;            // hexadecimal
constexpr std::size_t kMaxChunkExtension = 1024;       // of which nobody knows any
constexpr std::size_t kMaxTrailerBytes = 64UL * 1024;  // as of a head
constexpr int kBadRequest = 400;
constexpr int kUriTooLong = 414;
constexpr int kNotImplemented = 501;
// Those of RFC 9110 and 5789; the router knows which an address takes.
constexpr std::array<std::string_view, 9> kMethods{"GET",    "HEAD",    "POST",    "PUT",  "PATCH",
                                                   "DELETE", "OPTIONS", "CONNECT", "TRACE"};

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_token_character(char c) {
  constexpr std::string_view kOthers = "!#$%&'*+-.^_`|~";
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
         kOthers.find(c) != std::string_view::npos;
}

bool is_token(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, is_token_character);
}

bool is_control(char c) {
  return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

// What is wrong with the line of a field, "" if nothing is.
std::string_view fault_of_field(std::string_view line) {
  if (line.front() == ' ' || line.front() == '\t') {
    return "header fields must not be folded over lines";
  }
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) {
    return "a header field is not of the form name: value";
  }
  const std::string_view value = trimmed(line.substr(colon + 1));
  if (std::ranges::any_of(value, [](char c) { return c != '\t' && is_control(c); })) {
    return "a header field holds a control character";
  }
  return {};
}

// Whoever takes a trailer for a part of the head would read another request.
bool is_framing(std::string_view name) {
  return name == "content-length" || name == "transfer-encoding" || name == "host";
}

// A name, an IPv4 address or an IPv6 one in brackets, and perhaps a port.
bool is_host(std::string_view text) {
  if (text.empty()) return false;
  std::string_view name = text;
  std::string_view port;
  const std::size_t bracket = text.rfind(']');
  const std::size_t colon = text.find(':', bracket == std::string_view::npos ? 0 : bracket);
  if (colon != std::string_view::npos) {
    name = text.substr(0, colon);
    port = text.substr(colon + 1);
  }
  if (!std::ranges::all_of(port, is_digit) || port.size() > 5 || name.empty()) return false;
  if (name.front() == '[') {
    return name.size() > 2 && name.back() == ']' &&
           std::ranges::all_of(name.substr(1, name.size() - 2), [](char c) {
             return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F') || c == ':' ||
                    c == '.';
           });
  }
  return std::ranges::all_of(name, [](char c) {
    return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' ||
           c == '-' || c == '_';
  });
}

}  // namespace

bool HeadReader::refuse(int status, std::string detail) {
  fault_ = {status, std::move(detail)};
  return true;
}

bool HeadReader::add(std::string_view bytes) {
  // Another protocol, TLS for instance, need not send a line's end ever.
  if (lines_ == 0 && bytes.size() > length_ && !is_token_character(bytes[length_]) &&
      bytes[length_] != '\r' && bytes[length_] != '\n') {
    return refuse(kBadRequest, "this is no request of HTTP/1.1");
  }
  while (true) {
    const std::size_t end = bytes.find('\n', std::max(scanned_, length_));
    if (end == std::string_view::npos) {
      scanned_ = bytes.size();
      // Before its line ends: a target may be the only thing that ever comes.
      if (lines_ == 0 && bytes.size() - length_ > kMaxTargetBytes + kMaxLengthDigits) {
        return refuse(kUriTooLong, "the address is too long");
      }
      return false;
    }
    std::string_view line = bytes.substr(length_, end - length_);
    if (!line.ends_with('\r')) return refuse(kBadRequest, "a line ends without a carriage return");
    line.remove_suffix(1);
    line_ = length_;
    length_ = end + 1;
    if (take_line(line)) return true;
  }
}

bool HeadReader::take_line(std::string_view line) {
  // An empty line before a request is left over from a body of a careless client.
  if (lines_ == 0 && line.empty()) return false;
  if (++lines_ > kMaxLines) return refuse(kBadRequest, "there are too many header fields");
  if (lines_ == 1) return take_request_line(line);
  return line.empty() ? finish() : take_field(line);
}

bool HeadReader::take_request_line(std::string_view line) {
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == std::string_view::npos || last == first) {
    return refuse(kBadRequest, "this is no request of HTTP/1.1");
  }
  const std::string_view target = line.substr(first + 1, last - first - 1);
  const std::string_view version = line.substr(last + 1);
  head_.method = line.substr(0, first);
  head_.target = target;
  head_.is_http_1_0 = version == "HTTP/1.0";
  if (!is_token(head_.method) || target.empty() ||
      std::ranges::any_of(target, [](char c) { return c == ' ' || is_control(c); })) {
    return refuse(kBadRequest, "the request line is malformed");
  }
  if (version != "HTTP/1.1" && !head_.is_http_1_0) {
    return refuse(kBadRequest, "only HTTP/1.1 and HTTP/1.0 are spoken here");
  }
  if (target.size() > kMaxTargetBytes) return refuse(kUriTooLong, "the address is too long");
  if (std::ranges::find(kMethods, head_.method) == kMethods.end()) {
    return refuse(kNotImplemented,
                  "there is no method \"" + head_.method.substr(0, kShownMethod) + "\" here");
  }
  return false;
}

bool HeadReader::take_field(std::string_view line) {
  const std::string_view fault = fault_of_field(line);
  if (!fault.empty()) return refuse(kBadRequest, std::string(fault));
  const std::size_t colon = line.find(':');
  const std::string_view value = trimmed(line.substr(colon + 1));
  const std::string name = lower(line.substr(0, colon));
  if (name == "host") return take_host(value);
  if (name == "prefer" && lower(value).find("wait") != std::string::npos) head_.prefers_wait = true;
  if (name == "range") {
    // Several fields of one name are a list.
    head_.range.append(head_.range_lines.empty() ? "" : ",").append(value);
    head_.range_lines.emplace_back(line_, length_ - line_);
  }
  if (name == "expect") head_.expects_continue = lower(value) == "100-continue";
  return take_framing(name, value);
}

bool HeadReader::take_framing(std::string_view name, std::string_view value) {
  if (name == "content-length") {
    if (head_.has_content_length) {
      return refuse(kBadRequest, "give either one Content-Length or one Transfer-Encoding");
    }
    if (value.empty() || !std::ranges::all_of(value, is_digit)) {
      return refuse(kBadRequest, "Content-Length is not a number");
    }
    head_.has_content_length = true;
    // Longer than any body may be; what it says exactly does not matter.
    constexpr std::uint64_t kEndless = std::uint64_t{1} << 60U;
    const std::size_t zeros = std::min(value.find_first_not_of('0'), value.size() - 1);
    value.remove_prefix(zeros);
    if (value.size() > kMaxLengthDigits) {
      head_.content_length = kEndless;
    } else {
      std::from_chars(value.data(), value.data() + value.size(), head_.content_length);
    }
  } else if (name == "transfer-encoding") {
    if (++codings_ > 1) {
      return refuse(kBadRequest, "give either one Content-Length or one Transfer-Encoding");
    }
    head_.chunked = lower(value) == "chunked";
  }
  return false;
}

bool HeadReader::take_host(std::string_view value) {
  if (++hosts_ > 1) return refuse(kBadRequest, "there are two Host fields");
  // An empty one is allowed where the target has no authority; it names nothing.
  if (!value.empty() && !is_host(value)) return refuse(kBadRequest, "Host names no host");
  head_.host = lower(value);
  return false;
}

bool HeadReader::finish() {
  if (hosts_ == 0 && !head_.is_http_1_0) return refuse(kBadRequest, "the Host field is missing");
  if (codings_ > 0 && head_.has_content_length) {
    return refuse(kBadRequest, "give either one Content-Length or one Transfer-Encoding");
  }
  if (codings_ > 0 && head_.is_http_1_0) {
    return refuse(kBadRequest, "HTTP/1.0 knows no Transfer-Encoding");
  }
  return true;
}

bool ChunkGuard::pass_size(char c) {
  const bool is_hex = is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
  if (is_hex) {
    const int digit = is_digit(c) ? c - '0' : (c | 0x20) - 'a' + 10;
    left_ = left_ * 16 + static_cast<std::uint64_t>(digit);
    state_ = State::kSize;
    return ++digits_ <= kMaxChunkDigits;
  }
  if (digits_ == 0) return false;
  if (c == '\r') {
    state_ = State::kSizeEnd;
    return true;
  }
  extension_ = 0;
  state_ = State::kExtension;
  return c == ';';
}

bool ChunkGuard::pass_trailer(char c) {
  if (++trailer_bytes_ > kMaxTrailerBytes) return false;
  if (c != '\n') {
    field_ += c;
    return true;
  }
  if (!field_.ends_with('\r')) return false;
  field_.pop_back();
  if (field_.empty()) {
    state_ = State::kOver;
    return true;
  }
  const bool sound = ++fields_ <= kMaxLines && fault_of_field(field_).empty() &&
                     !is_framing(lower(std::string_view(field_).substr(0, field_.find(':'))));
  field_.clear();
  return sound;
}

std::size_t ChunkGuard::most() const {
  if (state_ == State::kOver) return std::numeric_limits<std::size_t>::max();
  return state_ == State::kData ? static_cast<std::size_t>(left_) : 1;
}

bool ChunkGuard::pass(std::string_view bytes) {
  while (!bytes.empty()) {
    const char c = bytes.front();
    if (state_ == State::kOver) return true;
    if (state_ == State::kData) {
      const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(left_, bytes.size()));
      left_ -= n;
      bytes.remove_prefix(n);
      if (left_ == 0) state_ = State::kDataReturn;
      continue;
    }
    bytes.remove_prefix(1);
    switch (state_) {
      case State::kSizeStart:
      case State::kSize:
        if (!pass_size(c)) return false;
        break;
      case State::kExtension:
        if (c == '\r') {
          state_ = State::kSizeEnd;
        } else if (is_control(c) || ++extension_ > kMaxChunkExtension) {
          return false;
        }
        break;
      case State::kSizeEnd:
        if (c != '\n') return false;
        state_ = left_ == 0 ? State::kTrailer : State::kData;
        digits_ = 0;
        break;
      case State::kDataReturn:
        if (c != '\r') return false;
        state_ = State::kDataEnd;
        break;
      case State::kDataEnd:
        if (c != '\n') return false;
        state_ = State::kSizeStart;
        break;
      case State::kTrailer:
        if (!pass_trailer(c)) return false;
        break;
      case State::kData:
      case State::kOver: break;
    }
  }
  return true;
}

}  // namespace symcell::server
