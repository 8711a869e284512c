#include "api/formats/dxf.hpp"

#include <dxflib/dl_creationadapter.h>
#include <dxflib/dl_dxf.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <sstream>
#include <utility>
#include <variant>

#include "api/formats/curve_drawing.hpp"
#include "api/formats/dxf_scan.hpp"
#include "api/formats/nurbs.hpp"
#include "api/printable.hpp"
#include "core/geometry/arc.hpp"

namespace symcell {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kFlatRel = 1e-6;                // of the extent: by which z coordinates may differ
constexpr std::size_t kDeepest = 32;             // blocks within blocks
constexpr std::size_t kMostPlaced = 10'000'000;  // curves and blocks, with all insertions

// x -> o + x.x * x + x.y * y
struct Placement {
  Point2 x{1, 0};
  Point2 y{0, 1};
  Point2 o;
  [[nodiscard]] Point2 direction(Point2 p) const { return p.x * x + p.y * y; }
  [[nodiscard]] Point2 operator()(Point2 p) const { return o + direction(p); }
  [[nodiscard]] Placement operator*(const Placement& inner) const {
    return {direction(inner.x), direction(inner.y), (*this)(inner.o)};
  }
};

struct Arc {  // centre + cos t * u + sin t * v; a whole turn for circles
  Point2 centre, u, v;
  double from = 0, to = 0;
};
struct Bulged {  // a straight line where the bulge is 0
  Point2 a, b;
  double bulge = 0;
};
struct Insertion {
  std::string block;
  Placement place;  // of the block's base point at the origin
  int columns = 1, rows = 1;
  Point2 column, row;  // steps
};
struct Seed {
  Point2 place;
};

struct Item {
  std::variant<Bulged, Arc, Nurbs, Insertion, Seed> shape;
  std::string layer;
  std::size_t entity = 0;  // in the scan's list
};

struct Block {
  Point2 base;
  std::vector<Item> items;
};

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

struct Polyline {
  bool closed = false;
  Placement own;
  Item item;
  std::vector<DL_VertexData> vertices;
};

// Takes what dxflib calls out as items of blocks; the drawing itself is the block "".
class Collector final : public DL_CreationAdapter {
 public:
  std::map<std::string, Block> blocks;  // by name in lower case: names differ by more
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  std::optional<std::size_t> tilted;  // an entity that is not drawn in the plane
  std::size_t highest_entity = 0;

  void finish() {
    end_spline();
    end_polyline();
  }

 private:
  [[nodiscard]] std::size_t entity() const {
    const int colour = attributes.getColor();
    return colour < 0 ? 0 : static_cast<std::size_t>(colour);
  }

  // Objects with a coordinate system of their own are seen from above or from below.
  Placement own_plane() {
    double n[3] = {0, 0, 1};
    if (extrusion != nullptr) extrusion->getDirection(n);
    if (std::abs(n[0]) + std::abs(n[1]) > kFlatRel * std::abs(n[2])) tilted = entity();
    return n[2] < 0 ? Placement{{-1, 0}, {0, 1}, {}} : Placement{};
  }

  void note_height(double z) {
    lowest = std::min(lowest, z);
    if (z > highest) highest_entity = entity();
    highest = std::max(highest, z);
  }

  template <class Shape>
  void add(Shape shape) {
    finish();
    block_->items.push_back({std::move(shape), attributes.getLayer(), entity()});
  }

  void addBlock(const DL_BlockData& data) override {
    finish();
    block_ = &blocks[lower(data.name)];
    // The first of several definitions counts, as the paper spaces' are all alike.
    if (!block_->items.empty()) block_ = &ignored_;
    block_->base = {data.bpx, data.bpy};
  }
  void endBlock() override {
    finish();
    block_ = &blocks[""];
  }
  void addPoint(const DL_PointData& p) override { add(Seed{{p.x, p.y}}); }
  void addLine(const DL_LineData& l) override {
    note_height(l.z1);
    note_height(l.z2);
    add(Bulged{{l.x1, l.y1}, {l.x2, l.y2}, 0});
  }
  void addArc(const DL_ArcData& a) override {
    double to = a.angle2;
    // From angle to angle counter-clockwise, whatever turns they are given with.
    to -= 360 * std::floor((to - a.angle1) / 360);
    if (!(to > a.angle1)) to = a.angle1 + 360;
    add_round(a.cx, a.cy, a.radius, kRadians * a.angle1, kRadians * to);
  }
  void addCircle(const DL_CircleData& c) override {
    add_round(c.cx, c.cy, c.radius, 0, 2 * std::numbers::pi);
  }
  void add_round(double x, double y, double radius, double from, double to) {
    const Placement own = own_plane();
    add(Arc{own({x, y}), own.direction({radius, 0}), own.direction({0, radius}), from, to});
  }
  void addEllipse(const DL_EllipseData& e) override {
    const Point2 u{e.mx, e.my};
    double n[3] = {0, 0, 1};
    if (extrusion != nullptr) extrusion->getDirection(n);
    const Point2 v = (n[2] < 0 ? -e.ratio : e.ratio) * Point2{-e.my, e.mx};
    double to = e.angle2 -
                2 * std::numbers::pi * std::floor((e.angle2 - e.angle1) / (2 * std::numbers::pi));
    if (!(to > e.angle1)) to = e.angle1 + 2 * std::numbers::pi;
    note_height(e.cz);
    add(Arc{{e.cx, e.cy}, u, v, e.angle1, to});
  }

  void addPolyline(const DL_PolylineData& p) override {
    finish();
    constexpr int kClosed = 1;
    polyline_.emplace();
    polyline_->closed = (p.flags & kClosed) != 0;
    polyline_->own = own_plane();
    polyline_->item = {Seed{}, attributes.getLayer(), entity()};
  }
  void addVertex(const DL_VertexData& v) override {
    if (polyline_) polyline_->vertices.push_back(v);
  }
  void end_polyline() {
    if (!polyline_) return;
    const Polyline line = std::move(*polyline_);
    polyline_.reset();
    const std::size_t count = line.vertices.size();
    const double sense = line.own.x.x;
    for (std::size_t i = 0; i + (line.closed ? 0 : 1) < count; ++i) {
      const DL_VertexData& a = line.vertices[i];
      const DL_VertexData& b = line.vertices[(i + 1) % count];
      Item item = line.item;
      item.shape = Bulged{line.own({a.x, a.y}), line.own({b.x, b.y}), sense * a.bulge};
      block_->items.push_back(std::move(item));
    }
  }

  void addSpline(const DL_SplineData& s) override {
    finish();
    spline_.emplace();
    spline_->degree = s.degree;
    spline_item_ = {Seed{}, attributes.getLayer(), entity()};
  }
  void addControlPoint(const DL_ControlPointData& p) override {
    if (!spline_) return;
    spline_->controls.push_back({p.x, p.y});
    spline_->weights.push_back(p.w);
  }
  void addKnot(const DL_KnotData& k) override {
    if (spline_) spline_->knots.push_back(k.k);
  }
  void end_spline() {
    if (!spline_) return;
    spline_item_.shape = std::move(*spline_);
    spline_.reset();
    block_->items.push_back(spline_item_);
  }

  void addInsert(const DL_InsertData& i) override {
    const Placement own = own_plane();
    const Point2 x = turned({1, 0}, kRadians * i.angle), y = turned({0, 1}, kRadians * i.angle);
    Insertion insertion;
    insertion.block = lower(i.name);
    insertion.place = own * Placement{i.sx * x, i.sy * y, {i.ipx, i.ipy}};
    insertion.columns = std::max(i.cols, 1);
    insertion.rows = std::max(i.rows, 1);
    insertion.column = own.direction(i.colSp * x);
    insertion.row = own.direction(i.rowSp * y);
    add(std::move(insertion));
  }

  Block ignored_;
  Block* block_ = &blocks[""];
  std::optional<Polyline> polyline_;
  std::optional<Nurbs> spline_;
  Item spline_item_;
};

class Builder {
 public:
  Builder(const Collector& drawing, const DxfScan& scan) : drawing_(drawing), scan_(scan) {
    for (const std::string& layer : scan.hidden_layers) hidden_layers_.insert(lower(layer));
  }

  Result<Pslg> run() {
    SYMCELL_TRY(check_flat());
    SYMCELL_TRY(place(drawing_.blocks.at(""), Placement{}, ""));
    pslg_.notes.left_out = scan_.left_out;
    if (skipped_ > 0) {
      pslg_.notes.left_out.push_back(std::to_string(skipped_) + " on the layer Defpoints");
    }
    for (const auto& [layer, count] : left_hidden_) {
      pslg_.notes.left_out.push_back(std::to_string(count) + " on the layer " + printable(layer) +
                                     ", which is frozen or off");
    }
    if (curves_.size() == 0) {
      return fail(ErrorCode::kEmptyFile,
                  "the drawing holds no lines, arcs or curves in model space" +
                      (pslg_.notes.left_out.empty() ? std::string() : "; left out: " + listed()));
    }
    SYMCELL_TRY(curves_.finish(pslg_));
    return std::move(pslg_);
  }

 private:
  [[nodiscard]] std::string listed() const {
    std::string text;
    for (const std::string& what : pslg_.notes.left_out) text += (text.empty() ? "" : ", ") + what;
    return text;
  }

  [[nodiscard]] std::string name(std::size_t entity) const {
    if (entity >= scan_.entities.size()) return "an entity";
    const DxfEntity& e = scan_.entities[entity];
    return "the " + e.type + " of line " + std::to_string(e.line);
  }

  [[nodiscard]] Result<void> check_flat() const {
    if (drawing_.tilted) {
      return fail(ErrorCode::kUnsupportedModel,
                  name(*drawing_.tilted) +
                      " is not drawn in the x-y plane; flatten the drawing in the CAD program");
    }
    // Drawings are some units wide, or else their heights say nothing.
    if (drawing_.highest - drawing_.lowest > kFlatRel * std::max(1.0, width())) {
      return fail(ErrorCode::kUnsupportedModel,
                  "z coordinates differ, up to " + std::to_string(drawing_.highest) + " at " +
                      name(drawing_.highest_entity) + "; flatten the drawing in the CAD program");
    }
    return {};
  }
  [[nodiscard]] double width() const {
    double most = 0;
    for (const Item& item : drawing_.blocks.at("").items) {
      if (const auto* line = std::get_if<Bulged>(&item.shape)) {
        most = std::max(most, distance(line->a, line->b));
      }
    }
    return most;
  }

  // `layer`: of the insertion; "" at the top.
  Result<void> place(const Block& block, const Placement& placement, const std::string& layer) {
    for (const Item& item : block.items) {
      if (++placed_ > kMostPlaced) {
        return fail(ErrorCode::kTooLarge,
                    "the blocks make more than " + std::to_string(kMostPlaced) +
                        " curves; simplify the drawing, near " + name(item.entity));
      }
      const std::string& own = item.layer == "0" && !layer.empty() ? layer : item.layer;
      if (lower(own) == "defpoints") {
        ++skipped_;
        continue;
      }
      // Nobody who looks at the drawing sees it.
      if (hidden_layers_.contains(lower(own))) {
        ++left_hidden_[own];
        continue;
      }
      SYMCELL_TRY(place(item, placement, own));
    }
    return {};
  }

  Result<void> place(const Item& item, const Placement& placement, const std::string& layer) {
    if (const auto* insertion = std::get_if<Insertion>(&item.shape)) {
      return insert(*insertion, item.entity, placement, layer);
    }
    if (const auto* seed = std::get_if<Seed>(&item.shape)) {
      const Point2 p = placement(seed->place);
      if (lower(layer).starts_with("hole")) {
        pslg_.holes.push_back(p);
      } else {
        pslg_.regions.push_back({p, marker(layer), std::numeric_limits<double>::infinity()});
      }
      return {};
    }
    const std::int32_t mark = marker(layer);
    if (const auto* arc = std::get_if<Arc>(&item.shape)) {
      curves_.add_ellipse(placement(arc->centre), placement.direction(arc->u),
                          placement.direction(arc->v), arc->from, arc->to, mark);
    } else if (const auto* line = std::get_if<Bulged>(&item.shape)) {
      add_bulged(*line, placement, mark);
    } else {
      return add_spline(std::get<Nurbs>(item.shape), item.entity, placement, mark);
    }
    return {};
  }

  void add_bulged(const Bulged& line, const Placement& placement, std::int32_t mark) {
    const double sense = cross(placement.x, placement.y) < 0 ? -1 : 1;
    const double size = squared_length(placement.x);
    const bool similar = std::abs(dot(placement.x, placement.y)) <= 1e-12 * size &&
                         std::abs(squared_length(placement.y) - size) <= 1e-12 * size;
    if (line.bulge == 0 || similar) {
      return curves_.add_arc(placement(line.a), placement(line.b), sense * line.bulge, mark);
    }
    if (line.a == line.b) return;
    const Point2 centre = arc_centre(line.a, line.b, line.bulge), u = line.a - centre;
    curves_.add_ellipse(placement(centre), placement.direction(u), placement.direction({-u.y, u.x}),
                        0, angle_of_bulge(line.bulge), mark);
  }

  Result<void> add_spline(Nurbs spline,
                          std::size_t entity,
                          const Placement& placement,
                          std::int32_t mark) {
    if (!spline.valid()) {
      const bool by_fit = spline.controls.empty();
      return fail(
          ErrorCode::kSyntax,
          name(entity) + (by_fit ? " has fit points only; give its control points, or "
                                   "convert it to a polyline"
                                 : " is none: " + std::to_string(spline.controls.size()) +
                                       " control points, " + std::to_string(spline.knots.size()) +
                                       " knots in ascending order and the degree " +
                                       std::to_string(spline.degree) + " do not fit"));
    }
    for (Point2& p : spline.controls) p = placement(p);
    const auto at = [&](double t) { return spline.at(t); };
    for (std::size_t k = spline.degree; k < spline.controls.size(); ++k) {
      if (spline.knots[k] < spline.knots[k + 1]) {
        curves_.add_curve(at, spline.knots[k], spline.knots[k + 1], mark);
      }
    }
    return {};
  }

  Result<void> insert(const Insertion& insertion,
                      std::size_t entity,
                      const Placement& placement,
                      const std::string& layer) {
    const auto found = drawing_.blocks.find(insertion.block);
    if (found == drawing_.blocks.end() || insertion.block.empty()) {
      return fail(ErrorCode::kMissingField, name(entity) + " names the block \"" +
                                                printable(insertion.block, 40) +
                                                "\", which the drawing lacks");
    }
    const bool within = std::ranges::find(within_, insertion.block) != within_.end();
    if (within || within_.size() == kDeepest) {
      return fail(ErrorCode::kSyntax, "the block \"" + printable(insertion.block, 40) + "\" " +
                                          (within ? "holds itself" : "is nested too deeply") +
                                          ", by " + name(entity));
    }
    within_.push_back(insertion.block);
    for (int r = 0; r < insertion.rows; ++r) {
      for (int c = 0; c < insertion.columns; ++c) {
        if (++placed_ > kMostPlaced) {
          return fail(ErrorCode::kTooLarge,
                      name(entity) + " places too many copies: " + std::to_string(insertion.rows) +
                          " rows and " + std::to_string(insertion.columns) + " columns");
        }
        Placement own = insertion.place;
        own.o = own.o + c * insertion.column + r * insertion.row;
        own.o = own(-1 * found->second.base);
        SYMCELL_TRY(place(found->second, placement * own, layer));
      }
    }
    within_.pop_back();
    return {};
  }

  std::int32_t marker(const std::string& layer) {
    if (layer == "0" || layer.empty()) return 0;
    const auto [it, fresh] =
        markers_.try_emplace(layer, static_cast<std::int32_t>(markers_.size()) + 1);
    if (fresh) {
      std::string name = layer;
      for (char& c : name) c = static_cast<unsigned char>(c) < ' ' ? '?' : c;
      pslg_.marker_names.push_back({it->second, std::move(name)});
    }
    return it->second;
  }

  const Collector& drawing_;
  const DxfScan& scan_;
  Pslg pslg_;
  CurveDrawing curves_;
  std::map<std::string, std::int32_t> markers_;
  std::vector<std::string> within_;  // blocks that are being placed
  std::size_t placed_ = 0;
  std::size_t skipped_ = 0;
  std::set<std::string> hidden_layers_;             // in lower case
  std::map<std::string, std::size_t> left_hidden_;  // entities by layer
};

}  // namespace

Result<Pslg> read_dxf(std::string_view bytes) {
  auto scan = scan_dxf(bytes);
  if (!scan) return error_of(scan);
  Collector drawing;
  std::istringstream stream(scan->text);
  DL_Dxf reader;
  if (!reader.in(stream, &drawing)) {
    return fail(ErrorCode::kUnreadable, "dxflib cannot read the drawing");
  }
  drawing.finish();
  return Builder(drawing, *scan).run();
}

}  // namespace symcell
