#include "server/base/metrics.hpp"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <map>
#include <mutex>

#include "core/base/assert.hpp"

namespace symcell::server {
namespace {

prometheus::Labels labels_of(std::initializer_list<MetricLabel> labels) {
  prometheus::Labels map;
  for (const auto& [name, value] : labels) map.emplace(name, value);
  return map;
}

template <class Families>
auto& found_in(Families& families, std::string_view name) {
  const auto family = families.find(name);
  SYMCELL_ASSERT(family != families.end());
  return family->second;
}

}  // namespace

struct Metrics::Impl {
  struct HistogramFamily {
    prometheus::Family<prometheus::Histogram>* family;
    std::vector<double> bounds;
  };

  mutable std::mutex mutex;  // guards the maps
  prometheus::Registry registry;
  std::map<std::string, prometheus::Family<prometheus::Counter>*, std::less<>> counters;
  std::map<std::string, prometheus::Family<prometheus::Gauge>*, std::less<>> gauges;
  std::map<std::string, HistogramFamily, std::less<>> histograms;
};

Metrics::Metrics() : impl_(std::make_unique<Impl>()) {
}

Metrics::~Metrics() = default;

void Metrics::declare_counter(const std::string& name, const std::string& help) {
  const std::lock_guard lock(impl_->mutex);
  impl_->counters[name] =
      &prometheus::BuildCounter().Name(name).Help(help).Register(impl_->registry);
}

void Metrics::declare_gauge(const std::string& name, const std::string& help) {
  const std::lock_guard lock(impl_->mutex);
  impl_->gauges[name] = &prometheus::BuildGauge().Name(name).Help(help).Register(impl_->registry);
}

void Metrics::declare_histogram(const std::string& name,
                                const std::string& help,
                                std::vector<double> bounds) {
  const std::lock_guard lock(impl_->mutex);
  impl_->histograms[name] = {
      &prometheus::BuildHistogram().Name(name).Help(help).Register(impl_->registry),
      std::move(bounds)};
}

void Metrics::count(std::string_view name,
                    std::initializer_list<MetricLabel> labels,
                    double amount) {
  const std::lock_guard lock(impl_->mutex);
  found_in(impl_->counters, name)->Add(labels_of(labels)).Increment(amount);
}

void Metrics::count_up_to(std::string_view name,
                          std::initializer_list<MetricLabel> labels,
                          double value) {
  const std::lock_guard lock(impl_->mutex);
  auto& counter = found_in(impl_->counters, name)->Add(labels_of(labels));
  counter.Increment(std::max(0.0, value - counter.Value()));
}

void Metrics::set(std::string_view name, std::initializer_list<MetricLabel> labels, double value) {
  const std::lock_guard lock(impl_->mutex);
  found_in(impl_->gauges, name)->Add(labels_of(labels)).Set(value);
}

void Metrics::observe(std::string_view name,
                      double value,
                      std::initializer_list<MetricLabel> labels) {
  const std::lock_guard lock(impl_->mutex);
  const Impl::HistogramFamily& histogram = found_in(impl_->histograms, name);
  histogram.family->Add(labels_of(labels), histogram.bounds).Observe(value);
}

std::string Metrics::text() const {
  auto families = impl_->registry.Collect();
  std::ranges::sort(families, {}, &prometheus::MetricFamily::name);
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace symcell::server
