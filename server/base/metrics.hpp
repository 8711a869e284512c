// Counters and histograms in the text format of Prometheus.
//
// Families are declared before use; every series of a family appears when it is first counted.
// Any thread may count.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace symcell::server {

using MetricLabel = std::pair<std::string_view, std::string_view>;

class Metrics {
 public:
  void declare_counter(std::string name, std::string help);
  // `bounds`: upper bounds of the buckets, ascending, without +Inf.
  void declare_histogram(std::string name, std::string help, std::vector<double> bounds);

  void count(std::string_view name, std::initializer_list<MetricLabel> labels = {});
  void observe(std::string_view name, double value, std::initializer_list<MetricLabel> labels = {});

  [[nodiscard]] std::string text() const;

  // One sample of a value read elsewhere, with its header lines.
  static void append_gauge_header(std::string& text, std::string_view name, std::string_view help);
  static void append_counter_header(std::string& text,
                                    std::string_view name,
                                    std::string_view help);
  static void append_sample(std::string& text,
                            std::string_view name,
                            std::initializer_list<MetricLabel> labels,
                            double value);

 private:
  struct Series {
    std::vector<std::uint64_t> buckets;  // histograms only; the last is +Inf
    double sum = 0;
    std::uint64_t count = 0;
  };
  struct Family {
    std::string help;
    std::vector<double> bounds;            // empty: a counter
    std::map<std::string, Series> series;  // by label text, e.g. `route="/v1/jobs",status="202"`
  };

  // Guards `families_` and all it holds.
  mutable std::mutex mutex_;
  std::map<std::string, Family, std::less<>> families_;
};

}  // namespace symcell::server
