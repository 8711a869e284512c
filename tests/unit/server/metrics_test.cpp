#include "server/base/metrics.hpp"

#include <gtest/gtest.h>

namespace symcell::server {
namespace {

TEST(MetricsTest, CountersAreTextOfPrometheus) {
  Metrics metrics;
  metrics.declare_counter("requests_total", "Requests.");
  metrics.count("requests_total", {{"route", "/a\"b\\"}, {"status", "200"}});
  metrics.count("requests_total", {{"route", "/a\"b\\"}, {"status", "200"}});
  EXPECT_EQ(metrics.text(),
            "# HELP requests_total Requests.\n# TYPE requests_total counter\n"
            "requests_total{route=\"/a\\\"b\\\\\",status=\"200\"} 2\n");
}

TEST(MetricsTest, HistogramsAreCumulative) {
  Metrics metrics;
  metrics.declare_histogram("seconds", "Time.", {0.5, 2});
  for (const double value : {0.1, 0.5, 1.0, 9.0}) metrics.observe("seconds", value);
  EXPECT_EQ(metrics.text(),
            "# HELP seconds Time.\n# TYPE seconds histogram\n"
            "seconds_count 4\nseconds_sum 10.6\n"
            "seconds_bucket{le=\"0.5\"} 2\nseconds_bucket{le=\"2\"} 3\n"
            "seconds_bucket{le=\"+Inf\"} 4\n");
}

}  // namespace
}  // namespace symcell::server
