// Points of the plane and of space: plain aggregates, double coordinates, input length units.
#pragma once

#include <cmath>

namespace symcell {

struct Point2 {
  double x = 0;
  double y = 0;
  friend bool operator==(const Point2&, const Point2&) = default;
};

struct Point3 {
  double x = 0;
  double y = 0;
  double z = 0;
  friend bool operator==(const Point3&, const Point3&) = default;
};

[[nodiscard]] inline Point2 operator+(Point2 a, Point2 b) {
  return {a.x + b.x, a.y + b.y};
}
[[nodiscard]] inline Point2 operator-(Point2 a, Point2 b) {
  return {a.x - b.x, a.y - b.y};
}
[[nodiscard]] inline Point2 operator*(double s, Point2 a) {
  return {s * a.x, s * a.y};
}
[[nodiscard]] inline double dot(Point2 a, Point2 b) {
  return a.x * b.x + a.y * b.y;
}
[[nodiscard]] inline double cross(Point2 a, Point2 b) {
  return a.x * b.y - a.y * b.x;
}
[[nodiscard]] inline double squared_length(Point2 a) {
  return dot(a, a);
}
[[nodiscard]] inline double length(Point2 a) {
  return std::sqrt(dot(a, a));
}
[[nodiscard]] inline double squared_distance(Point2 a, Point2 b) {
  return squared_length(a - b);
}
[[nodiscard]] inline double distance(Point2 a, Point2 b) {
  return length(a - b);
}

[[nodiscard]] inline Point3 operator+(Point3 a, Point3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[nodiscard]] inline Point3 operator-(Point3 a, Point3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[nodiscard]] inline Point3 operator*(double s, Point3 a) {
  return {s * a.x, s * a.y, s * a.z};
}
[[nodiscard]] inline double dot(Point3 a, Point3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] inline Point3 cross(Point3 a, Point3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline double squared_length(Point3 a) {
  return dot(a, a);
}
[[nodiscard]] inline double length(Point3 a) {
  return std::sqrt(dot(a, a));
}
[[nodiscard]] inline double squared_distance(Point3 a, Point3 b) {
  return squared_length(a - b);
}
[[nodiscard]] inline double distance(Point3 a, Point3 b) {
  return length(a - b);
}

}  // namespace symcell
