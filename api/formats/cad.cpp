#include "api/formats/cad.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <array>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "api/cad/cad_module.hpp"
#include "api/printable.hpp"
#include "core/base/child_process.hpp"

namespace symcell {
namespace {

// A file of 10 MB takes some seconds and 500 MB. What takes so long goes round in circles.
constexpr std::uint64_t kCpuSeconds = 30;
constexpr std::uint64_t kBytesPerSecond = 100'000;
constexpr std::uint64_t kMemory = std::uint64_t{2} << 30U;
constexpr std::uint64_t kMemoryPerByte = 100;
// Chords of wide radii may be so far from them, of the diameter: less than a third of the symmetry tolerance.
constexpr double kDeflectionRel = 3e-4;
// More are no CAD model, and take minutes to clean.
constexpr std::uint64_t kMostTriangles = 20'000'000;

std::string_view name_of(CadFormat format) {
  return format == CadFormat::kStep ? "STEP" : "IGES";
}

// Beside the program, or where packages have it. The variable is for programs elsewhere, as tests.
std::string find_module() {
  const char* given =
      std::getenv("SYMCELL_CAD_MODULE");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  if (given != nullptr) return given;
  std::array<char, PATH_MAX> path{};
  const ssize_t length = ::readlink("/proc/self/exe", path.data(), path.size());
  if (length <= 0) return {};
  std::string folder(path.data(), static_cast<std::size_t>(length));
  folder.resize(folder.rfind('/') + 1);
  for (const char* place : {"", "../lib/symcell/"}) {
    std::string file = folder + place + cad::kModuleFile;
    if (::access(file.c_str(), R_OK) == 0) return file;
  }
  return {};
}

bool write_piece(void* sink, const void* bytes, std::size_t size) {
  auto& output = *static_cast<ChildOutput*>(sink);
  output.write(std::span(static_cast<const std::byte*>(bytes), size));
  return output.good();
}

// In the child.
bool read_in_module(const std::string& module, const cad::Request& request, ChildOutput& output) {
  void* library = ::dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return false;
  const auto read =
      reinterpret_cast<cad::ReadFunction>(::dlsym(library, cad::kReadFunction));  // NOLINT
  return read != nullptr && read(&request, write_piece, &output);
}

// What it answered, checked as if a stranger had: it has read a stranger's file.
class AnswerReader {
 public:
  explicit AnswerReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  bool get(T& value) {
    if (bytes_.size() < sizeof value) return false;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_ = bytes_.subspan(sizeof value);
    return true;
  }
  bool get_text(std::string& text) {
    std::uint32_t size = 0;
    if (!get(size) || size > bytes_.size()) return false;
    text.assign(reinterpret_cast<const char*>(bytes_.data()), size);  // NOLINT
    bytes_ = bytes_.subspan(size);
    return true;
  }
  template <class T>
  bool get_all(std::vector<T>& values, std::uint64_t count) {
    if (count > bytes_.size() / sizeof(T)) return false;
    values.resize(static_cast<std::size_t>(count));
    if (count > 0) std::memcpy(values.data(), bytes_.data(), values.size() * sizeof(T));
    bytes_ = bytes_.subspan(values.size() * sizeof(T));
    return true;
  }

  bool get_surface(TriangleSurface& surface) {
    return get_notes(surface) && get_faces(surface) && get_triangles(surface) && bytes_.empty();
  }

 private:
  bool get_notes(TriangleSurface& surface) {
    CadNotes notes;
    std::uint32_t solids = 0;
    if (!get_text(notes.unit) || !get(solids) || solids > bytes_.size()) return false;
    notes.solids.resize(solids);
    for (std::string& name : notes.solids) {
      if (!get_text(name)) return false;
      name = printable(name, kLongestName);
    }
    notes.unit = printable(notes.unit, kLongestName);
    if (!get(notes.mended) || !get(notes.left_out) || !get(notes.inner_faces)) return false;
    surface.cad_notes = std::move(notes);
    return true;
  }

  bool get_faces(TriangleSurface& surface) {
    std::uint32_t faces = 0;
    if (!get(faces) || faces > bytes_.size()) return false;
    surface.cad_faces.resize(faces);
    for (CadFace& face : surface.cad_faces) {
      std::uint32_t kind = 0;
      AnalyticSurface& s = face.surface;
      if (!get(kind) || kind > static_cast<std::uint32_t>(FaceKind::kSurface)) return false;
      s.kind = static_cast<FaceKind>(kind);
      for (double* x :
           {&s.origin.x, &s.origin.y, &s.origin.z, &s.direction.x, &s.direction.y, &s.direction.z,
            &s.apex.x, &s.apex.y, &s.apex.z, &s.radius, &s.tube_radius, &s.half_angle}) {
        if (!get(*x) || !std::isfinite(*x)) return false;
      }
      if (!get_text(face.name) || !get(face.colour)) return false;
      face.name = printable(face.name, kLongestName);
    }
    return true;
  }

  bool get_triangles(TriangleSurface& surface) {
    std::uint64_t vertices = 0, triangles = 0;
    if (!get(vertices) || vertices > INT_MAX || !get_all(surface.vertices, vertices) ||
        !get(triangles) || triangles > kMostTriangles || !get_all(surface.triangles, triangles) ||
        !get_all(surface.cad_face, triangles)) {
      return false;
    }
    const auto is_below = [](std::int32_t i, std::size_t count) {
      return i >= 0 && static_cast<std::size_t>(i) < count;
    };
    for (const auto& t : surface.triangles) {
      for (const std::int32_t v : t) {
        if (!is_below(v, surface.vertices.size())) return false;
      }
    }
    for (const std::int32_t f : surface.cad_face) {
      if (!is_below(f, surface.cad_faces.size())) return false;
    }
    return true;
  }

  static constexpr std::size_t kLongestName = 64;

  std::span<const std::byte> bytes_;
};

Result<TriangleSurface> decoded(std::span<const std::byte> bytes, CadFormat format) {
  const std::string file = "the " + std::string(name_of(format)) + " file";
  AnswerReader reader(bytes);
  cad::Status status{};
  std::string text;
  TriangleSurface surface;
  if (!reader.get(status) ||
      (status == cad::Status::kRead ? !reader.get_surface(surface) : !reader.get_text(text))) {
    return fail(ErrorCode::kInternal, file + ": what OpenCASCADE made of it is damaged");
  }
  switch (status) {
    case cad::Status::kRead: break;
    case cad::Status::kNoShape:
      return fail(ErrorCode::kDegenerateGeometry,
                  file + " cannot be meshed: " + text + "; export a solid");
    case cad::Status::kTooLarge:
      return fail(ErrorCode::kTooLarge,
                  file + " is too fine: " + text + "; give a larger chord_error, or export STL");
    case cad::Status::kNotTessellated:
      return fail(
          ErrorCode::kUnsupportedModel,
          file + " cannot be meshed: " + text + "; repair it in the CAD program, or export STL");
    default:
      return fail(ErrorCode::kSyntax, file + " cannot be read: " + printable(text, 200) +
                                          "; was it written completely?");
  }
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    const Point3& p = surface.vertices[i];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
    return fail(ErrorCode::kNonFinite, file + ": a point of its faces is not finite");
  }
  surface.source_face = surface.cad_face;
  return surface;
}

}  // namespace

static_assert(sizeof(Point3) == 3 * sizeof(double), "points are copied as bytes");

bool looks_like_step(std::string_view bytes) {
  constexpr std::string_view kFirst = "ISO-10303-21";
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  return begin != std::string_view::npos && bytes.substr(begin).starts_with(kFirst);
}

// Lines of 80 columns: the 73rd is S, then follows a number.
bool looks_like_iges(std::string_view bytes) {
  constexpr std::size_t kSection = 72;
  constexpr std::size_t kEnd = 80;
  if (bytes.size() < kEnd) return false;
  const std::string_view line = bytes.substr(0, kEnd);
  if (line.find_first_of("\r\n") != std::string_view::npos || line[kSection] != 'S') return false;
  const std::string_view number = line.substr(kSection + 1);
  return number.find_first_not_of(" 0") == number.size() - 1 && number.back() == '1';
}

std::string_view cad_library() {
  return SYMCELL_CAD_LIBRARY;
}

Result<TriangleSurface> read_cad(std::string_view bytes,
                                 CadFormat format,
                                 double chord_error_rel,
                                 ExecutionContext& context) {
  const std::string name(name_of(format));
  if (cad_library().empty()) {
    return fail(ErrorCode::kUnsupportedModel, "this build does not read " + name +
                                                  ": it was made without OpenCASCADE; export the "
                                                  "solid as STL");
  }
  const std::string module = find_module();
  if (module.empty()) {
    return fail(ErrorCode::kUnsupportedModel,
                std::string(cad::kModuleFile) + ", which reads " + name +
                    ", is not beside the program nor in ../lib/symcell; install it, or export the "
                    "solid as STL");
  }
  cad::Request request;
  request.kind = format == CadFormat::kStep ? cad::FileKind::kStep : cad::FileKind::kIges;
  request.bytes = bytes.data();
  request.size = bytes.size();
  request.chord_error_rel = chord_error_rel;
  request.deflection_rel = kDeflectionRel;
  request.most_triangles = kMostTriangles;
  const ChildLimits limits{kCpuSeconds + bytes.size() / kBytesPerSecond,
                           kMemory + kMemoryPerByte * bytes.size()};
  const auto child =
      run_in_child([&](ChildOutput& output) { return read_in_module(module, request, output); },
                   limits, context);
  if (!child) return error_of(child);
  switch (child->failure) {
    case ChildFailure::kNone: return decoded(child->bytes, format);
    case ChildFailure::kRefused:
      return fail(ErrorCode::kUnsupportedModel,
                  "OpenCASCADE, which reads " + name +
                      ", could not be loaded, or ran out of memory; export the solid as STL");
    case ChildFailure::kCpuLimit:
      return fail(ErrorCode::kTimeLimit,
                  "OpenCASCADE took more than " + std::to_string(limits.cpu_seconds) +
                      " s to read the " + name + " file; simplify it, or export the solid as STL");
    case ChildFailure::kCrashed: break;
  }
  return fail(ErrorCode::kSyntax, "OpenCASCADE crashed on the " + name +
                                      " file, which is damaged or refers to itself; write it "
                                      "again, or export the solid as STL");
}

}  // namespace symcell
