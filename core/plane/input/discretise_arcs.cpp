#include "core/plane/input/discretise_arcs.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>

#include "core/base/index.hpp"
#include "core/geometry/arc.hpp"
#include "core/geometry/point_grid.hpp"
#include "core/geometry/segment_index.hpp"
#include "core/model/describe.hpp"
#include "core/plane/input/arc_chains.hpp"
#include "core/plane/input/curve_set.hpp"
#include "core/plane/input/curve_symmetry.hpp"
#include "core/plane/input/validate_pslg.hpp"

namespace symcell::plane {
namespace {

// Share of the diameter within which a vertex is on an arc: what drawings with ten digits keep.
constexpr double kOnArcRel = 1e-9;
// Of the angle of a chord: rounding must not give copies of an arc different numbers of chords.
constexpr double kSameCount = 1e-6;
constexpr double kMostBulge = 1e4;  // less than 1/5000 of a turn from a full one
constexpr int kMostDoublings = 8;   // of the chords of arcs that lie close
constexpr double kCoarsestChord = std::numbers::pi / 3;
constexpr std::int64_t kPlainFold = 12;  // circles about one centre alone: chords by the dozen

// Of the angle at which a point sees a chord: on an arc it is known no better where it is an end's neighbour.
constexpr double kOnArcAngle = 1e-7;

// Whether p lies between the chord from a to b and its arc, or on either. From a point of the arc the chord is
// seen at half the angle that the arc leaves of a full turn, from within at more.
bool between_chord_and_arc(Point2 p, Point2 a, Point2 b, double bulge) {
  const Point2 u = a - p, v = b - p;
  const double side = cross(u, v);
  if (side * bulge > 0) return false;  // beside the chord where the arc is not
  const double seen = std::atan2(std::abs(side), dot(u, v));
  return seen >= std::numbers::pi - std::abs(angle_of_bulge(bulge)) / 2 - kOnArcAngle;
}

// A face has chords where the model has arcs: a seed between the two is in another face than it was put in,
// and one on an arc in neither.
Result<void> check_seeds_beside_arcs(const Pslg& model, const ChordedPslg& chorded) {
  const Pslg& pslg = chorded.pslg;
  if (pslg.holes.empty() && pslg.regions.empty()) return {};
  std::vector<IndexedSegment> chords;
  double farthest = 0;  // that an arc is from its chord
  for (std::size_t s = 0; s < pslg.segments.size(); ++s) {
    const Point2 a = pslg.vertices[at(pslg.segments[s].a)],
                 b = pslg.vertices[at(pslg.segments[s].b)];
    chords.push_back({a, b});
    farthest = std::max(farthest, std::abs(pslg.bulge(s)) / 2 * distance(a, b));
  }
  const SegmentIndex index(chords);
  const auto check = [&](Point2 p, const char* list, std::size_t i,
                         const char* what) -> Result<void> {
    const auto hit = index.nearest(p, (1 + kOnArcRel) * farthest, [&](std::int32_t s) {
      const double bulge = pslg.bulge(at(s));
      return bulge != 0 && between_chord_and_arc(p, chords[at(s)].a, chords[at(s)].b, bulge);
    });
    if (hit.segment < 0) return {};
    const std::int32_t source = chorded.source[at(hit.segment)];
    return fail(
        ErrorCode::kUnreachableSeed,
        std::string(what) + " " + std::to_string(i) + " at " + describe_point(p) +
            " lies on the arc of segment " + std::to_string(source) + " of marker " +
            std::to_string(model.segments[at(source)].marker) +
            ", or between the arc and its chords; move it into the face it is meant for, or "
            "give a smaller chord_error",
        {static_cast<std::int64_t>(i)}, "/" + std::string(list) + "/" + std::to_string(i));
  };
  for (std::size_t i = 0; i < pslg.holes.size(); ++i) {
    SYMCELL_TRY(check(pslg.holes[i], "holes", i, "hole seed"));
  }
  for (std::size_t i = 0; i < pslg.regions.size(); ++i) {
    SYMCELL_TRY(check(pslg.regions[i].point, "regions", i, "region seed"));
  }
  return {};
}

Result<void> check_bulges(const Pslg& pslg) {
  for (std::size_t s = 0; s < pslg.bulges.size(); ++s) {
    if (std::abs(pslg.bulges[s]) <= kMostBulge) continue;
    return fail(ErrorCode::kDegenerateGeometry,
                "the arc of segment " + std::to_string(s) + " has a bulge of " +
                    describe_number(pslg.bulges[s]) +
                    ", which is no number or all but a full circle; give a circle as two arcs",
                {static_cast<std::int64_t>(s)}, "/segments/" + std::to_string(s));
  }
  return {};
}

class Discretiser {
 public:
  Discretiser(const Pslg& pslg, const MeshOptions& options) : pslg_(pslg), options_(options) {
    Point2 low = pslg.vertices.front(), high = low;
    for (const Point2 p : pslg.vertices) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    diameter_ = distance(low, high);
    tolerance_ = options.symmetry_tolerance_rel.value_or(kExactSymmetryToleranceRel) * diameter_;
    arcs_ = chain_arcs(pslg, kOnArcRel * diameter_, std::vector<char>(pslg.vertices.size(), 0));
    symmetry_ = find_curve_symmetry(pslg, arcs_, options, tolerance_);
    keep_symmetric_joints();
    find_ends_joined_twice();
  }

  Result<ChordedPslg> run(ExecutionContext& context) {
    while (true) {
      SYMCELL_TRY(context.check());
      ChordedPslg result;
      SYMCELL_TRY(cut(result));
      auto valid = validate_pslg(result.pslg, context);
      if (valid) {
        SYMCELL_TRY(check_seeds_beside_arcs(pslg_, result));
        return result;
      }
      Error error = valid.error();
      if (!may_mend(error, result) || !double_chords(error))
        return fail(in_numbers_of_model(std::move(error), result));
    }
  }

 private:
  // Joints whose copies are vertices are vertices the user may count on.
  void keep_symmetric_joints() {
    const bool any = symmetry_.fold == 0;
    if (any) return;
    PointGrid grid(2 * tolerance_, pslg_.vertices.size());
    for (std::size_t v = 0; v < pslg_.vertices.size(); ++v) {
      grid.insert(pslg_.vertices[v] - symmetry_.centre, static_cast<std::int32_t>(v));
    }
    std::vector<char> keeps(pslg_.vertices.size(), 0);
    for (std::size_t v = 0; v < keeps.size(); ++v) {
      if (arcs_.is_joint[v] == 0) continue;
      const Point2 p = pslg_.vertices[v] - symmetry_.centre;
      bool permuted = true;
      for (std::int32_t k = 1; k < symmetry_.fold && permuted; ++k) {
        const double angle = 2 * std::numbers::pi * k / symmetry_.fold;
        permuted = grid.nearest(turned(p, angle)) >= 0;
      }
      keeps[v] = permuted ? 1 : 0;
    }
    arcs_ = chain_arcs(pslg_, kOnArcRel * diameter_, keeps);
  }

  // A line or another arc between the ends of an arc encloses something with it only if the arc has
  // an inner vertex.
  void find_ends_joined_twice() {
    using Ends = std::pair<std::int32_t, std::int32_t>;
    std::vector<std::pair<Ends, ArcChain*>> joined;
    for (std::size_t s = 0; s < pslg_.segments.size(); ++s) {
      const PslgSegment& segment = pslg_.segments[s];
      if (pslg_.bulge(s) == 0) joined.push_back({std::minmax(segment.a, segment.b), nullptr});
    }
    for (ArcChain& chain : arcs_.chains) {
      if (!chain.whole()) joined.push_back({std::minmax(chain.a, chain.b), &chain});
    }
    std::sort(joined.begin(), joined.end(),
              [](const auto& x, const auto& y) { return x.first < y.first; });
    for (std::size_t i = 1; i < joined.size(); ++i) {
      if (joined[i].first != joined[i - 1].first) continue;
      for (ArcChain* chain : {joined[i].second, joined[i - 1].second}) {
        if (chain != nullptr) chain->ends_joined_twice = true;
      }
    }
  }

  [[nodiscard]] bool about_centre(const ArcChain& chain) const {
    return distance(chain.centre, symmetry_.centre) <= tolerance_;
  }

  // Before what the symmetry and the chain's vertices ask for.
  [[nodiscard]] std::int64_t least_chords(const ArcChain& chain) const {
    double step = kCoarsestChord;
    for (const std::int32_t s : chain.segments) {
      if (pslg_.chord_angle(at(s)) > 0) step = std::min(step, pslg_.chord_angle(at(s)));
    }
    // What the model asks for stands in place of the option.
    const double error = step < kCoarsestChord ? kMaxChordErrorRel : options_.chord_error_rel;
    step = std::min(step, widest_chord(chain.radius, error, options_.max_edge));
    double count = std::ceil(std::abs(chain.angle) / step - kSameCount);
    if (options_.min_edge > 0) {
      // A chord is an edge that the mesher makes: not shorter than the least.
      const double least = 2 * std::asin(std::min(1.0, options_.min_edge / (2 * chain.radius)));
      const double coarsest = std::ceil(std::abs(chain.angle) / kCoarsestChord - kSameCount);
      count = std::min(count, std::max(coarsest, std::floor(std::abs(chain.angle) / least)));
    }
    const auto most = static_cast<double>(kMaxPslgVertices) + 1;
    return static_cast<std::int64_t>(std::clamp(count, 1.0, most)) << chain.doublings;
  }

  [[nodiscard]] std::int64_t chords(const ArcChain& chain, std::int64_t common) const {
    std::int64_t count = least_chords(chain);
    if (chain.ends_joined_twice) count = std::max<std::int64_t>(count, 2);
    if (chain.whole() && about_centre(chain)) count = (count + common - 1) / common * common;
    const std::size_t held =
        std::max(chain.segments.size(), chain.joints.size() + (chain.whole() ? 0 : 1));
    while (count < static_cast<std::int64_t>(held)) count *= 2;
    return count;
  }

  // What the chords of circles about the centre are a multiple of.
  [[nodiscard]] std::int64_t common_count() const {
    if (symmetry_.fold > 0) return symmetry_.fold;
    std::int64_t least = kMaxPslgVertices;
    for (const ArcChain& chain : arcs_.chains) least = std::min(least, least_chords(chain));
    return (least + kPlainFold - 1) / kPlainFold * kPlainFold;
  }

  Result<void> cut(ChordedPslg& result) {
    result.pslg = pslg_;
    result.pslg.bulges.resize(pslg_.segments.size(), 0);
    result.pslg.chord_angles.clear();
    result.source.resize(pslg_.segments.size());
    for (std::size_t s = 0; s < result.source.size(); ++s) {
      result.source[s] = static_cast<std::int32_t>(s);
    }
    std::vector<char> taken(pslg_.segments.size(), 0);
    const std::int64_t common = common_count();
    chain_of_.assign(pslg_.segments.size(), -1);
    for (std::size_t c = 0; c < arcs_.chains.size(); ++c) {
      const std::int64_t count = chords(arcs_.chains[c], common);
      if (result.pslg.vertices.size() + static_cast<std::size_t>(count) > kMaxPslgVertices) {
        return fail(ErrorCode::kTooLarge,
                    "the arcs have more than " + std::to_string(kMaxPslgVertices) +
                        " chords; raise chord_error or max_edge",
                    {}, "/options/chord_error");
      }
      cut(static_cast<std::int32_t>(c), count, taken, result);
    }
    return {};
  }

  void cut(std::int32_t c, std::int64_t count, std::vector<char>& taken, ChordedPslg& result) {
    const ArcChain& chain = arcs_.chains[at(c)];
    Pslg& out = result.pslg;
    std::size_t joints = 0, segments = 0;
    const auto add_vertex = [&](Point2 p) {
      if (joints < chain.joints.size()) {
        const std::int32_t v = chain.joints[joints++];
        out.vertices[at(v)] = p;
        return v;
      }
      out.vertices.push_back(p);
      return static_cast<std::int32_t>(out.vertices.size() - 1);
    };
    const double step = chain.angle / static_cast<double>(count);
    const Point2 spoke = first_spoke(chain);
    std::int32_t last = chain.whole() ? add_vertex(chain.centre + spoke) : chain.a;
    const std::int32_t first = last;
    for (std::int64_t i = 1; i <= count; ++i) {
      const std::int32_t end = chain.whole() ? first : chain.b;
      const std::int32_t v =
          i == count ? end
                     : add_vertex(chain.centre + turned(spoke, static_cast<double>(i) * step));
      while (segments < chain.segments.size() && taken[at(chain.segments[segments])] != 0) {
        ++segments;
      }
      const PslgSegment chord{last, v, chain.marker};
      if (segments < chain.segments.size()) {
        const std::int32_t s = chain.segments[segments++];
        taken[at(s)] = 1;
        out.segments[at(s)] = chord;
        out.bulges[at(s)] = bulge_of_angle(step);
        chain_of_[at(s)] = c;
      } else {
        out.segments.push_back(chord);
        out.bulges.push_back(bulge_of_angle(step));
        const std::int64_t share =
            (i - 1) * static_cast<std::int64_t>(chain.segments.size()) / count;
        result.source.push_back(chain.segments[static_cast<std::size_t>(share)]);
        chain_of_.push_back(c);
      }
      last = v;
    }
  }

  // From the circle's centre to the first vertex.
  [[nodiscard]] Point2 first_spoke(const ArcChain& chain) const {
    if (!chain.whole()) return pslg_.vertices[at(chain.a)] - chain.centre;
    const Point2 outwards = chain.centre - symmetry_.centre;
    if (!about_centre(chain)) return chain.radius / length(outwards) * outwards;
    const Point2 given = pslg_.vertices[at(chain.joints.front())] - chain.centre;
    // All circles about the centre are cut in one phase, that of the axes.
    return {length(given), 0};
  }

  // Whether chords meet and their arcs do not, but at vertices.
  [[nodiscard]] bool may_mend(const Error& error, const ChordedPslg& chorded) const {
    if (error.code != ErrorCode::kSelfIntersection &&
        error.code != ErrorCode::kOverlappingSegments) {
      return false;
    }
    const auto source = [&](std::size_t i) {
      return at(chorded.source[static_cast<std::size_t>(error.elements[i])]);
    };
    const double near = kOnArcRel * diameter_;
    const std::vector<Point2> places = meeting_places(pslg_, source(0), source(1), near);
    return std::all_of(places.begin(), places.end(), [&](Point2 p) {
      return std::any_of(pslg_.vertices.begin(), pslg_.vertices.end(),
                         [&](Point2 v) { return distance(p, v) <= 2 * near; });
    });
  }

  // Of the arcs that cross and their copies; false if none may have more.
  bool double_chords(const Error& error) {
    std::vector<ArcChain> crossing;
    for (const std::int64_t s : error.elements) {
      const std::int32_t c = chain_of_[static_cast<std::size_t>(s)];
      if (c >= 0) crossing.push_back(arcs_.chains[at(c)]);
    }
    bool doubled = false;
    for (ArcChain& chain : arcs_.chains) {
      const bool alike = std::any_of(crossing.begin(), crossing.end(),
                                     [&](const ArcChain& other) { return is_copy(chain, other); });
      if (!alike || chain.doublings == kMostDoublings) continue;
      ++chain.doublings;
      doubled = true;
    }
    return doubled;
  }

  [[nodiscard]] bool is_copy(const ArcChain& a, const ArcChain& b) const {
    const auto from_centre = [&](const ArcChain& c) {
      return distance(c.centre, symmetry_.centre);
    };
    return std::abs(a.radius - b.radius) <= tolerance_ &&
           std::abs(std::abs(a.angle) - std::abs(b.angle)) * a.radius <= 4 * tolerance_ &&
           std::abs(from_centre(a) - from_centre(b)) <= tolerance_;
  }

  // Chords are named as their arcs.
  [[nodiscard]] Error in_numbers_of_model(Error error, const ChordedPslg& chorded) const {
    if (error.code == ErrorCode::kDuplicateVertices) return meeting_arcs(std::move(error), chorded);
    const bool of_segments = error.pointer.starts_with("/segments/");
    if (!of_segments) return error;
    std::string note;
    std::int64_t last = 0;
    for (std::int64_t& s : error.elements) {
      const auto index = static_cast<std::size_t>(s);
      if (index < chorded.source.size() && chain_of_[index] >= 0) {
        const std::int32_t source = chorded.source[index];
        note += (note.empty() ? " (segment " : ", segment ") + std::to_string(s) +
                " is a chord of the arc of segment " + std::to_string(source);
        s = source;
      }
      last = std::max(last, s);
    }
    if (!note.empty()) error.message += note + ")";
    error.pointer = "/segments/" + std::to_string(last);
    return error;
  }

  // Two vertices at one place, of which a chord made one: there its arc meets something.
  [[nodiscard]] Error meeting_arcs(Error error, const ChordedPslg& chorded) const {
    const auto made = [&](std::int64_t v) {
      return v >= std::ssize(pslg_.vertices) || arcs_.is_joint[static_cast<std::size_t>(v)] != 0;
    };
    if (std::none_of(error.elements.begin(), error.elements.end(), made)) return error;
    std::vector<std::int64_t> segments;
    for (const std::int64_t v : error.elements) {
      const auto& all = chorded.pslg.segments;
      const auto with = std::find_if(all.begin(), all.end(),
                                     [v](const PslgSegment& s) { return s.a == v || s.b == v; });
      if (with != all.end()) {
        segments.push_back(chorded.source[static_cast<std::size_t>(with - all.begin())]);
      }
    }
    if (segments.size() != 2) return error;
    const Point2 place = chorded.pslg.vertices[static_cast<std::size_t>(error.elements.front())];
    return {ErrorCode::kSelfIntersection,
            "segments " + std::to_string(segments[0]) + " and " + std::to_string(segments[1]) +
                " meet near " + describe_point(place) +
                ", where they share no vertex; add one there and split both, or give repair=all",
            segments, "/segments/" + std::to_string(std::max(segments[0], segments[1]))};
  }

  const Pslg& pslg_;
  const MeshOptions& options_;
  double diameter_ = 0;
  double tolerance_ = 0;
  ArcChains arcs_;
  CurveSymmetry symmetry_;
  std::vector<std::int32_t> chain_of_;  // per segment of the result, -1: a straight one
};

}  // namespace

Result<ChordedPslg> discretise_arcs(const Pslg& pslg,
                                    const MeshOptions& options,
                                    ExecutionContext& context) {
  SYMCELL_TRY(check_entities(pslg));
  SYMCELL_TRY(check_bulges(pslg));
  return Discretiser(pslg, options).run(context);
}

}  // namespace symcell::plane
