// Figures for Prometheus, kept by prometheus-cpp: counters, gauges and histograms by name.
//
// A family is declared once, which gives its help text; a series of it appears when it is first
// counted. Any thread may count.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace symcell::server {

using MetricLabel = std::pair<std::string_view, std::string_view>;

class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  void declare_counter(const std::string& name, const std::string& help);
  void declare_gauge(const std::string& name, const std::string& help);
  // `bounds`: upper bounds of the buckets, ascending, without +Inf.
  void declare_histogram(const std::string& name,
                         const std::string& help,
                         std::vector<double> bounds);

  // All require that the name was declared.
  void count(std::string_view name,
             std::initializer_list<MetricLabel> labels = {},
             double amount = 1);
  // For a counter that is kept elsewhere and never goes back.
  void count_up_to(std::string_view name, std::initializer_list<MetricLabel> labels, double value);
  void set(std::string_view name, std::initializer_list<MetricLabel> labels, double value);
  void observe(std::string_view name, double value, std::initializer_list<MetricLabel> labels = {});

  // In the text format, families in order of their names.
  [[nodiscard]] std::string text() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Figures of this process as client libraries name them: processor time, memory, descriptors, start.
void declare_process_metrics(Metrics& metrics);
void report_process_metrics(Metrics& metrics);

}  // namespace symcell::server
