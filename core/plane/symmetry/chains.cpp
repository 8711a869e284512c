#include "core/plane/symmetry/chains.hpp"

#include <algorithm>
#include <utility>

#include "core/base/index.hpp"

namespace symcell::plane {
namespace {

PreparedEdge reversed(PreparedEdge edge) {
  std::swap(edge.a, edge.b);
  std::swap(edge.left, edge.right);
  std::swap(edge.left_label, edge.right_label);
  return edge;
}

class Walker {
 public:
  Walker(const PreparedPslg& prepared, std::int32_t centre)
      : prepared_(prepared), visited_(prepared.edges.size(), 0) {
    list_incident_edges();
    find_junctions(centre);
  }

  Chains run() {
    for (const std::int32_t j : result_.junctions) {
      for (std::int32_t i = first_[at(j)]; i < first_[at(j) + 1]; ++i) walk(j, incident_[at(i)]);
    }
    for (std::size_t e = 0; e < visited_.size(); ++e) {
      walk(prepared_.edges[e].a, static_cast<std::int32_t>(e));
    }
    return std::move(result_);
  }

 private:
  void list_incident_edges() {
    const std::size_t points = prepared_.points.size();
    result_.degree.assign(points, 0);
    for (const PreparedEdge& e : prepared_.edges) {
      ++result_.degree[at(e.a)];
      ++result_.degree[at(e.b)];
    }
    first_.assign(points + 1, 0);
    for (std::size_t v = 0; v < points; ++v) first_[v + 1] = first_[v] + result_.degree[v];
    incident_.resize(2 * prepared_.edges.size());
    std::vector<std::int32_t> fill(first_.begin(), first_.end() - 1);
    for (std::size_t e = 0; e < prepared_.edges.size(); ++e) {
      for (const std::int32_t v : {prepared_.edges[e].a, prepared_.edges[e].b}) {
        incident_[at(fill[at(v)]++)] = static_cast<std::int32_t>(e);
      }
    }
  }

  void find_junctions(std::int32_t centre) {
    is_junction_.assign(prepared_.points.size(), 0);
    for (std::size_t v = 0; v < is_junction_.size(); ++v) {
      const auto point = static_cast<std::int32_t>(v);
      if (result_.degree[v] == 0) {
        if (point != centre) result_.lone.push_back(point);
        continue;
      }
      if (point != centre && result_.degree[v] == 2 && continues(point)) continue;
      is_junction_[v] = 1;
      result_.junctions.push_back(point);
    }
  }

  // Seen from the vertex.
  [[nodiscard]] PreparedEdge leaving(std::int32_t v, std::int32_t e) const {
    const PreparedEdge& edge = prepared_.edges[at(e)];
    return edge.a == v ? edge : reversed(edge);
  }

  [[nodiscard]] bool continues(std::int32_t v) {
    const PreparedEdge in = reversed(leaving(v, incident_[at(first_[at(v)])]));
    const PreparedEdge out = leaving(v, incident_[at(first_[at(v)]) + 1]);
    return in.left == out.left && in.right == out.right &&
           (in.marker == out.marker || prepared_.ignore_markers);
  }

  void walk(std::int32_t start, std::int32_t edge) {
    if (visited_[at(edge)] != 0) return;
    Chain chain;
    chain.kind = leaving(start, edge);
    chain.points.push_back(start);
    std::int32_t v = start;
    while (edge >= 0 && visited_[at(edge)] == 0) {
      visited_[at(edge)] = 1;
      const PreparedEdge step = leaving(v, edge);
      if (step.marker != chain.kind.marker) result_.mixed_markers = true;
      v = step.b;
      chain.points.push_back(v);
      if (is_junction_[at(v)] != 0) break;
      const std::int32_t* around = &incident_[at(first_[at(v)])];
      edge = around[0] == edge ? around[1] : around[0];
    }
    if (is_junction_[at(start)] == 0) close_loop(chain);
    result_.chains.push_back(std::move(chain));
  }

  void close_loop(Chain& chain) const {
    chain.loop = true;
    chain.points.pop_back();
    double area = 0;
    const Point2 origin = prepared_.points[at(chain.points.front())];
    for (std::size_t i = 0; i + 1 < chain.points.size(); ++i) {
      area += cross(prepared_.points[at(chain.points[i])] - origin,
                    prepared_.points[at(chain.points[i + 1])] - origin);
    }
    if (area >= 0) return;
    std::reverse(chain.points.begin() + 1, chain.points.end());
    chain.kind = reversed(chain.kind);
  }

  const PreparedPslg& prepared_;
  std::vector<char> visited_;
  std::vector<std::int32_t> first_;     // per point, into incident_
  std::vector<std::int32_t> incident_;  // edges
  std::vector<char> is_junction_;
  Chains result_;
};

}  // namespace

Chains make_chains(const PreparedPslg& prepared, std::int32_t centre) {
  return Walker(prepared, centre).run();
}

}  // namespace symcell::plane
