#include "server/base/metrics.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/base/assert.hpp"

namespace symcell::server {
namespace {

void append_number(std::string& text, double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

std::string label_text(std::initializer_list<MetricLabel> labels) {
  std::string text;
  for (const auto& [key, value] : labels) {
    if (!text.empty()) text.push_back(',');
    text.append(key).append("=\"");
    for (const char c : value) {
      if (c == '"' || c == '\\') text.push_back('\\');
      if (c == '\n') {
        text.append("\\n");
      } else {
        text.push_back(c);
      }
    }
    text.push_back('"');
  }
  return text;
}

void append_line(std::string& text,
                 std::string_view name,
                 std::string_view suffix,
                 std::string_view labels,
                 double value) {
  text.append(name).append(suffix);
  if (!labels.empty()) text.append("{").append(labels).append("}");
  text.push_back(' ');
  append_number(text, value);
  text.push_back('\n');
}

void append_header(std::string& text,
                   std::string_view name,
                   std::string_view help,
                   std::string_view type) {
  text.append("# HELP ").append(name).append(" ").append(help).append("\n");
  text.append("# TYPE ").append(name).append(" ").append(type).append("\n");
}

}  // namespace

void Metrics::declare_counter(std::string name, std::string help) {
  const std::lock_guard lock(mutex_);
  families_[std::move(name)].help = std::move(help);
}

void Metrics::declare_histogram(std::string name, std::string help, std::vector<double> bounds) {
  const std::lock_guard lock(mutex_);
  Family& family = families_[std::move(name)];
  family.help = std::move(help);
  family.bounds = std::move(bounds);
}

void Metrics::count(std::string_view name, std::initializer_list<MetricLabel> labels) {
  const std::string key = label_text(labels);
  const std::lock_guard lock(mutex_);
  const auto family = families_.find(name);
  SYMCELL_ASSERT(family != families_.end());
  ++family->second.series[key].count;
}

void Metrics::observe(std::string_view name,
                      double value,
                      std::initializer_list<MetricLabel> labels) {
  const std::string key = label_text(labels);
  const std::lock_guard lock(mutex_);
  const auto family = families_.find(name);
  SYMCELL_ASSERT(family != families_.end());
  const std::vector<double>& bounds = family->second.bounds;
  Series& series = family->second.series[key];
  series.buckets.resize(bounds.size() + 1);
  const auto bucket = std::ranges::lower_bound(bounds, value) - bounds.begin();
  ++series.buckets[static_cast<std::size_t>(bucket)];
  series.sum += value;
  ++series.count;
}

std::string Metrics::text() const {
  std::string text;
  const std::lock_guard lock(mutex_);
  for (const auto& [name, family] : families_) {
    const bool histogram = !family.bounds.empty();
    append_header(text, name, family.help, histogram ? "histogram" : "counter");
    for (const auto& [labels, series] : family.series) {
      if (!histogram) {
        append_line(text, name, "", labels, static_cast<double>(series.count));
        continue;
      }
      std::uint64_t cumulative = 0;
      for (std::size_t i = 0; i < series.buckets.size(); ++i) {
        cumulative += series.buckets[i];
        std::string bucket_labels = labels.empty() ? "le=\"" : labels + ",le=\"";
        if (i < family.bounds.size()) {
          append_number(bucket_labels, family.bounds[i]);
        } else {
          bucket_labels.append("+Inf");
        }
        bucket_labels.push_back('"');
        append_line(text, name, "_bucket", bucket_labels, static_cast<double>(cumulative));
      }
      append_line(text, name, "_sum", labels, series.sum);
      append_line(text, name, "_count", labels, static_cast<double>(series.count));
    }
  }
  return text;
}

void Metrics::append_gauge_header(std::string& text, std::string_view name, std::string_view help) {
  append_header(text, name, help, "gauge");
}

void Metrics::append_counter_header(std::string& text,
                                    std::string_view name,
                                    std::string_view help) {
  append_header(text, name, help, "counter");
}

void Metrics::append_sample(std::string& text,
                            std::string_view name,
                            std::initializer_list<MetricLabel> labels,
                            double value) {
  append_line(text, name, "", label_text(labels), value);
}

}  // namespace symcell::server
