// Writes numbers, texts and lists of an answer.
#pragma once

#include <string>
#include <vector>

#include "api/cad/cad_module.hpp"

namespace symcell::cad {

class Answer {
 public:
  Answer(Write write, void* sink) : write_(write), sink_(sink) {}

  template <class T>
  void put(const T& value) {
    put_bytes(&value, sizeof value);
  }
  void put_text(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    put_bytes(text.data(), text.size());
  }
  void put_texts(const std::vector<std::string>& texts) {
    put(static_cast<std::uint32_t>(texts.size()));
    for (const std::string& text : texts) put_text(text);
  }
  // Without their number.
  template <class T>
  void put_all(const std::vector<T>& values) {
    put_bytes(values.data(), values.size() * sizeof(T));
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  void put_bytes(const void* bytes, std::size_t size) {
    if (size > 0) good_ = good_ && write_(sink_, bytes, size);
  }

  Write write_;
  void* sink_;
  bool good_ = true;
};

}  // namespace symcell::cad
