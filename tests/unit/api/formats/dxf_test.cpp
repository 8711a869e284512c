#include "api/formats/dxf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "api/formats/dxf_scan.hpp"
#include "core/geometry/arc.hpp"

namespace symcell {
namespace {

// Codes and values in turn, as lines.
std::string groups(const std::string& words) {
  std::istringstream stream(words);
  std::string text, word;
  while (stream >> word) text += word + "\n";
  return text;
}

std::string drawing(const std::string& entities, const std::string& blocks = {}) {
  return groups("0 SECTION 2 HEADER 9 $ACADVER 1 AC1015 0 ENDSEC") + groups("0 SECTION 2 BLOCKS") +
         blocks + groups("0 ENDSEC") + groups("0 SECTION 2 ENTITIES") + entities +
         groups("0 ENDSEC 0 EOF");
}

std::string line(const std::string& layer, double x1, double y1, double x2, double y2) {
  return groups("0 LINE 8 " + std::string(layer) + " 10 " + std::string(std::to_string(x1)) +
                " 20 " + std::string(std::to_string(y1)) + " 11 " +
                std::string(std::to_string(x2)) + " 21 " + std::string(std::to_string(y2)));
}

Pslg read(const std::string& text) {
  const auto model = read_dxf(text);
  EXPECT_TRUE(model) << model.error().message;
  return model ? *model : Pslg{};
}

void expect_error(const std::string& text, ErrorCode code, const std::string& part) {
  const auto model = read_dxf(text);
  ASSERT_FALSE(model) << part;
  EXPECT_EQ(error_code_name(model.error().code), error_code_name(code)) << model.error().message;
  EXPECT_NE(model.error().message.find(part), std::string::npos) << model.error().message;
}

// Area by the vertices of segments that follow each other, and of the arcs beside their chords.
double area_of(const Pslg& pslg) {
  double area = 0;
  for (std::size_t s = 0; s < pslg.segments.size(); ++s) {
    const Point2 a = pslg.vertices[static_cast<std::size_t>(pslg.segments[s].a)];
    const Point2 b = pslg.vertices[static_cast<std::size_t>(pslg.segments[s].b)];
    area += 0.5 * cross(a, b);
    if (pslg.bulge(s) == 0) continue;
    const double angle = angle_of_bulge(pslg.bulge(s)), radius = arc_radius(a, b, pslg.bulge(s));
    area += 0.5 * radius * radius * (angle - std::sin(angle));
  }
  return area;
}

TEST(Dxf, LinesShareTheirEndsAndLayersAreMarkers) {
  const Pslg pslg = read(drawing(line("0", 0, 0, 1, 0) + line("side", 1, 0, 0, 1) +
                                 line("side", 0, 1, 0, 0) + line("side", 0, 0, 0, 1)));
  EXPECT_EQ(pslg.vertices.size(), 3U);
  ASSERT_EQ(pslg.segments.size(), 3U);  // one is drawn twice
  EXPECT_EQ(pslg.segments[0].marker, 0);
  EXPECT_EQ(pslg.segments[1].marker, 1);
  EXPECT_EQ(pslg.marker_names, (std::vector<MarkerName>{{1, "side"}}));
  EXPECT_TRUE(pslg.bulges.empty());
}

TEST(Dxf, ArcsAndCircles) {
  const Pslg arc = read(drawing(groups("0 ARC 8 0 10 1 20 2 40 3 50 270 51 30")));
  ASSERT_EQ(arc.segments.size(), 1U);
  EXPECT_NEAR(arc.vertices[0].y, -1, 1e-12);
  EXPECT_NEAR(angle_of_bulge(arc.bulge(0)), 2 * std::numbers::pi / 3, 1e-12);
  const Pslg circle = read(drawing(groups("0 CIRCLE 8 0 10 1 20 2 40 3")));
  EXPECT_EQ(circle.segments.size(), 2U);
  EXPECT_NEAR(area_of(circle), 9 * std::numbers::pi, 1e-12);
}

TEST(Dxf, PolylinesWithBulges) {
  const std::string light = groups("0 LWPOLYLINE 8 0 90 3 70 1 10 0 20 0 10 2 20 0 42 1 10 2 20 2");
  const std::string heavy = groups("0 POLYLINE 8 0 66 1 70 1") + groups("0 VERTEX 8 0 10 0 20 0") +
                            groups("0 VERTEX 8 0 10 2 20 0 42 1") +
                            groups("0 VERTEX 8 0 10 2 20 2") + groups("0 SEQEND");
  for (const std::string& text : {light, heavy}) {
    const Pslg pslg = read(drawing(text));
    EXPECT_EQ(pslg.segments.size(), 3U);
    EXPECT_NEAR(area_of(pslg), 2 + std::numbers::pi / 2, 1e-12);
  }
}

TEST(Dxf, EllipsesAndSplinesBecomeArcs) {
  const Pslg ellipse =
      read(drawing(groups("0 ELLIPSE 8 0 10 1 20 1 11 3 21 0 40 0.5 41 0 42 6.283185307179586")));
  EXPECT_NEAR(area_of(ellipse), 4.5 * std::numbers::pi, 1e-3);
  EXPECT_LT(ellipse.segments.size(), 200U);
  // A quarter circle as a rational spline of degree 2, closed by two lines.
  const std::string quarter = groups(
      "0 SPLINE 8 0 70 4 71 2 72 6 73 3 74 0 40 0 40 0 40 0 40 1 40 1 40 1 10 1 20 0 30 0 41 1 10 "
      "1 20 1 30 0 41 0.70710678118654752 10 0 20 1 30 0 41 1");
  const Pslg sector = read(drawing(quarter + line("0", 0, 1, 0, 0) + line("0", 0, 0, 1, 0)));
  EXPECT_NEAR(area_of(sector), std::numbers::pi / 4, 1e-5);
}

TEST(Dxf, BlocksAreInsertedTurnedScaledAndMirrored) {
  const std::string block = groups("0 BLOCK 8 0 2 Part 10 1 20 0") +
                            groups("0 LWPOLYLINE 8 0 90 2 70 1 10 1 20 0 42 1 10 2 20 0 42 0") +
                            groups("0 ENDBLK 8 0");
  const auto insert = [](const char* more) {
    return groups("0 INSERT 8 parts 2 PART 10 0 20 0") + groups(more);
  };
  // Half a circle of diameter 1 below its line.
  const double half = std::numbers::pi / 8;
  const Pslg turned_part = read(drawing(insert("50 90 41 2 42 2"), block));
  EXPECT_NEAR(area_of(turned_part), 4 * half, 1e-12);
  EXPECT_NEAR(turned_part.vertices[1].y, 2, 1e-12);
  EXPECT_EQ(turned_part.segments[0].marker, 1);
  const Pslg mirrored = read(drawing(insert("41 -1"), block));
  EXPECT_NEAR(area_of(mirrored), -half, 1e-12);
  const Pslg squeezed = read(drawing(insert("42 0.5"), block));
  EXPECT_NEAR(area_of(squeezed), half / 2, 1e-4);
  const Pslg array = read(drawing(insert("70 3 71 2 44 5 45 7"), block));
  EXPECT_EQ(array.segments.size(), 12U);
}

TEST(Dxf, PointsAreSeeds) {
  const auto point = [](const char* layer, const char* x) {
    return groups("0 POINT 8 " + std::string(layer) + " 10 " + std::string(x) + " 20 0");
  };
  const Pslg pslg = read(drawing(line("0", 0, 0, 1, 0) + point("Holes", "3") + point("iron", "4")));
  ASSERT_EQ(pslg.holes.size(), 1U);
  EXPECT_EQ(pslg.holes[0], (Point2{3, 0}));
  ASSERT_EQ(pslg.regions.size(), 1U);
  EXPECT_EQ(pslg.regions[0].attribute, 1);
}

TEST(Dxf, WhatIsNoPartOfTheModelIsLeftOutAndTold) {
  const std::string text = groups("0 TEXT 8 0 1 hello 10 0 20 0");
  const std::string hatch = groups("0 HATCH 8 0 91 99999999");
  const std::string paper = groups("0 LINE 8 0 67 1 10 x");
  const Pslg pslg =
      read(drawing(line("0", 0, 0, 1, 0) + text + hatch + hatch + line("Defpoints", 5, 5, 6, 6)));
  EXPECT_EQ(pslg.segments.size(), 1U);
  EXPECT_EQ(pslg.notes.left_out,
            (std::vector<std::string>{"2 HATCH", "1 TEXT", "1 on the layer Defpoints"}));
  expect_error(drawing(paper), ErrorCode::kSyntax, "LINE of line");
}

TEST(Dxf, WhatNobodySeesIsLeftOutAndTold) {
  const std::string layers = groups(
      "0 SECTION 2 TABLES 0 TABLE 2 LAYER 70 3 0 LAYER 2 Dim 70 1 62 7 0 LAYER 2 Off 70 0 62 -7 "
      "0 LAYER 2 Seen 70 64 62 7 0 ENDTAB 0 ENDSEC");
  const std::string seen = line("seen", 0, 0, 1, 0);
  const std::string unseen =
      line("dim", 0, 0, 0, 1) + line("Off", 1, 0, 1, 1) + line("Off", 2, 0, 2, 1);
  const Pslg pslg = read(layers + drawing(seen + unseen));
  EXPECT_EQ(pslg.segments.size(), 1U);
  EXPECT_EQ(pslg.notes.left_out,
            (std::vector<std::string>{"2 on the layer Off, which is frozen or off",
                                      "1 on the layer dim, which is frozen or off"}));
  expect_error(layers + drawing(unseen), ErrorCode::kEmptyFile, "frozen or off");
}

TEST(Dxf, NamesWhatIsWrong) {
  const std::string good = drawing(line("0", 0, 0, 1, 0));
  for (std::size_t size = 30; size < good.size() - 5; size += 7) {
    const auto cut = read_dxf(std::string_view(good).substr(0, size));
    ASSERT_FALSE(cut) << size;
    EXPECT_NE(cut.error().message.find("line"), std::string::npos) << cut.error().message;
  }
  expect_error(good.substr(0, good.find("11\n1")), ErrorCode::kTruncated, "LINE of line 21");
  expect_error(drawing(groups("0 LINE 8 0 10 nan")), ErrorCode::kNonFinite, "group 10 of the LINE");
  expect_error(drawing(groups("0 CIRCLE 8 0 10 1e999")), ErrorCode::kNonFinite, "CIRCLE");
  expect_error(drawing(groups("0 LWPOLYLINE 8 0 90 2000000000 70 0 10 0 20 0")),
               ErrorCode::kCountMismatch, "is said to have 2000000000 vertices");
  expect_error(drawing(groups("0 SPLINE 8 0 71 3 72 -5 10 0 20 0")), ErrorCode::kCountMismatch,
               "knots");
  expect_error(drawing(groups("0 SPLINE 8 0 71 3 10 0 20 0")), ErrorCode::kSyntax, "do not fit");
  expect_error(drawing(groups("0 INSERT 8 0 2 none 10 0 20 0")), ErrorCode::kMissingField,
               "\"none\"");
  expect_error(drawing(line("0", 0, 0, 1, 0) +
                       groups("0 ARC 8 0 10 0 20 0 40 1 50 0 51 9 210 1 220 0 230 0")),
               ErrorCode::kUnsupportedModel, "ARC");
  expect_error(drawing(""), ErrorCode::kEmptyFile, "no lines");
  expect_error("AutoCAD Binary DXF\r\n\x1a", ErrorCode::kUnsupportedModel, "binary");
}

TEST(Dxf, BlocksThatHoldThemselvesAreRefused) {
  const auto holding = [](const char* name, const char* other) {
    return groups("0 BLOCK 8 0 2 " + std::string(name) + " 10 0 20 0") +
           groups("0 INSERT 8 0 2 " + std::string(other) + " 10 0 20 0") +
           groups("0 INSERT 8 0 2 " + std::string(other) + " 10 0 20 0") + groups("0 ENDBLK 8 0");
  };
  const std::string insert = groups("0 INSERT 8 0 2 b0 10 0 20 0");
  expect_error(drawing(insert, holding("b0", "b1") + holding("b1", "b0")), ErrorCode::kSyntax,
               "holds itself");
  // Two copies of two copies, and so on.
  std::string deep;
  for (int i = 0; i < 30; ++i) {
    deep += holding(("b" + std::to_string(i)).c_str(), ("b" + std::to_string(i + 1)).c_str());
  }
  deep += groups("0 BLOCK 8 0 2 b30 10 0 20 0") + groups("0 ENDBLK 8 0");
  expect_error(drawing(insert, deep), ErrorCode::kTooLarge, "more than 10000000");
  expect_error(drawing(groups("0 INSERT 8 0 2 b30 10 0 20 0 70 2000000000 71 2000000000"), deep),
               ErrorCode::kTooLarge, "too many");
}

}  // namespace
}  // namespace symcell
