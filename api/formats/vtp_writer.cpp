// The boundary as VTK PolyData: triangles of solids, lines in the plane; quadratic facets in straight
// parts between all their nodes. Points are the mesh's nodes, with their numbers.
#include <array>

#include "api/formats/decks/deck_groups.hpp"
#include "api/formats/mesh_formats.hpp"
#include "api/formats/vtu_encoder.hpp"

namespace symcell::internal {
namespace {

// Where a facet lies.
enum Side : std::int32_t { kOuter = 0, kLower = 1, kHigher = 2, kInner = 3 };

constexpr std::array<std::array<std::size_t, 3>, 1> kTriangle{{{0, 1, 2}}};
constexpr std::array<std::array<std::size_t, 3>, 4> kTriangle6{
    {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
constexpr std::array<std::array<std::size_t, 3>, 1> kLine{{{0, 1, 0}}};
constexpr std::array<std::array<std::size_t, 3>, 2> kLine3{{{0, 2, 0}, {2, 1, 0}}};

class VtpWriter {
 public:
  VtpWriter(MeshStream& mesh, std::vector<ElementSide> sides)
      : mesh_(mesh), cell_(mesh.cell()), sides_(std::move(sides)) {
    if (cell_.dimension == 3) {
      parts_ = cell_.order == 1 ? Parts(kTriangle) : Parts(kTriangle6);
    } else {
      parts_ = cell_.order == 1 ? Parts(kLine) : Parts(kLine3);
    }
    bounds_ = mesh.full() ? 0 : cell_.lower_facets.size() / mesh.nodes_per_facet();
    count_ = (mesh.facet_count() + 2 * static_cast<std::int64_t>(bounds_)) *
             static_cast<std::int64_t>(parts_.size());
  }

  void write(VtuEncoding encoding, ByteWriter& out) {
    const VtuEncoder encoder(encoding, arrays());
    const bool lines = cell_.dimension == 2;
    out.text(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
        "byte_order=\"LittleEndian\" header_type=\"UInt64\"");
    if (encoding == VtuEncoding::kAppendedZlib) out.text(" compressor=\"vtkZLibDataCompressor\"");
    out.text(">\n<PolyData>\n<Piece NumberOfPoints=\"");
    out.integer(mesh_.node_count());
    out.text("\" NumberOfVerts=\"0\" NumberOfLines=\"");
    out.integer(lines ? count_ : 0);
    out.text("\" NumberOfStrips=\"0\" NumberOfPolys=\"");
    out.integer(lines ? 0 : count_);
    out.text("\">\n<CellData>\n");
    for (std::size_t i = 0; i < 2; ++i) encoder.write_element(out, i, false);
    out.text("</CellData>\n<Points>\n");
    encoder.write_element(out, 2, false);
    out.text(lines ? "</Points>\n<Lines>\n" : "</Points>\n<Polys>\n");
    for (std::size_t i = 3; i < 5; ++i) encoder.write_element(out, i, false);
    out.text(lines ? "</Lines>\n" : "</Polys>\n");
    out.text("</Piece>\n</PolyData>\n");
    if (encoding != VtuEncoding::kAscii) {
      out.text("<AppendedData encoding=\"raw\">\n_");
      encoder.write_appended(out);
      out.text("\n</AppendedData>\n");
    }
    out.text("</VTKFile>\n");
  }

 private:
  using Parts = std::span<const std::array<std::size_t, 3>>;

  // f(nodes, marker, side) for every facet: those of the model, then both bounds.
  template <class F>
  void each_facet(F f) {
    mesh_.each_facet_index([&](std::span<const std::int64_t> nodes, std::size_t b, std::int32_t s) {
      f(nodes, cell_.boundary_marker(b, s), sides_[b].inner ? kInner : kOuter);
    });
    const std::size_t k = mesh_.nodes_per_facet();
    for (const Side side : {kLower, kHigher}) {
      const auto& facets = side == kLower ? cell_.lower_facets : cell_.higher_facets;
      for (std::size_t i = 0; i < bounds_ * k; i += k) {
        std::array<std::int64_t, MeshStream::kMostNodes> nodes{};
        std::copy_n(facets.begin() + static_cast<std::ptrdiff_t>(i), k, nodes.begin());
        f(std::span<const std::int64_t>(nodes.data(), k), 0, side);
      }
    }
  }

  VtuArray int32_array(std::string_view name, std::function<void(VtuValues&)> generate) const {
    return {name, "Int32", 4, 1, static_cast<std::uint64_t>(count_), std::move(generate)};
  }

  std::vector<VtuArray> arrays() {
    const std::uint64_t corners = cell_.dimension == 3 ? 3 : 2;
    std::vector<VtuArray> arrays;
    arrays.push_back(int32_array("marker", [this](VtuValues& out) {
      each_facet([&](std::span<const std::int64_t>, std::int32_t marker, Side) {
        for (std::size_t i = 0; i < parts_.size(); ++i) out.put(marker);
      });
    }));
    arrays.push_back(int32_array("side", [this](VtuValues& out) {
      each_facet([&](std::span<const std::int64_t>, std::int32_t, Side side) {
        for (std::size_t i = 0; i < parts_.size(); ++i) out.put(static_cast<std::int32_t>(side));
      });
    }));
    arrays.push_back({"Points", "Float64", 8, 3, static_cast<std::uint64_t>(mesh_.node_count()),
                      [this](VtuValues& out) {
                        mesh_.each_node([&](const Point3& p, std::int32_t) {
                          out.put(p.x);
                          out.put(p.y);
                          out.put(p.z);
                        });
                      }});
    arrays.push_back({"connectivity", "Int64", 8, 1, static_cast<std::uint64_t>(count_) * corners,
                      [this, corners](VtuValues& out) {
                        each_facet([&](std::span<const std::int64_t> nodes, std::int32_t, Side) {
                          for (const auto& part : parts_) {
                            for (std::size_t i = 0; i < corners; ++i) out.put(nodes[part[i]]);
                          }
                        });
                      }});
    arrays.push_back({"offsets", "Int64", 8, 1, static_cast<std::uint64_t>(count_),
                      [this, corners](VtuValues& out) {
                        for (std::int64_t i = 1; i <= count_; ++i) {
                          out.put(i * static_cast<std::int64_t>(corners));
                        }
                      }});
    return arrays;
  }

  MeshStream& mesh_;
  const SymmetryCellMesh& cell_;
  std::vector<ElementSide> sides_;
  Parts parts_;
  std::size_t bounds_ = 0;  // facets of each
  std::int64_t count_ = 0;  // of the file's lines or triangles
};

}  // namespace

Result<void> write_vtp(MeshStream& mesh, VtuEncoding encoding, ByteWriter& out) {
  auto sides = facet_sides(mesh.cell());
  if (!sides) return error_of(sides);
  VtpWriter(mesh, std::move(*sides)).write(encoding, out);
  return {};
}

}  // namespace symcell::internal
