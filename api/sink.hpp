// Where writers put their bytes: a file, a socket, a string. No sockets or files are known here.
#pragma once

#include <functional>
#include <string_view>

namespace symcell {

// Takes the next piece of the output; false: the receiver is gone or full, stop writing
// (the writer then returns kWriteFailed).
using Sink = std::function<bool(std::string_view)>;

}  // namespace symcell
