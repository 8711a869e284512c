// What a program that loads this module knows of it: one function, and the bytes that it hands back.
//
// The module holds OpenCASCADE, which takes 25 MB and a tenth of a second to load and was not written
// for hostile files. So it is no part of the program: it is loaded by a child process that reads one
// file and ends. Numbers are written as they are in memory, texts and lists with their count before
// them.
#pragma once

#include <cstddef>
#include <cstdint>

namespace symcell::cad {

// A module of another version is not loaded.
inline constexpr std::uint32_t kModuleVersion = 2;
inline constexpr const char* kModuleFile = "symcell_cad.so";
inline constexpr const char* kReadFunction = "symcell_read_cad";

enum class FileKind : std::uint32_t { kStep, kIges };

struct Request {
  std::uint32_t version = kModuleVersion;
  FileKind kind = FileKind::kStep;
  const char* bytes = nullptr;
  std::size_t size = 0;
  double chord_error_rel = 1e-3;  // of chords from the true surface, of its radius
  double deflection_rel = 3e-4;   // likewise, of the diameter
  std::uint64_t most_triangles = 0;
};

// Takes bytes of the answer; false: no more are wanted.
using Write = bool (*)(void* sink, const void* bytes, std::size_t size);

// The answer is a status, then, unless that is kRead, a text for the user, and else
//   text    the file's unit of length; coordinates are in millimetres whatever it is
//   texts   names of the solids, which may be empty
//   u32 x 3 solids mended; shapes left out, being no part of a solid; faces between two solids, which are
//           left out
//   u32     faces, each: u32 kind as in FaceKind (plane, cylinder, cone, sphere, torus, other),
//           double x 12 origin, direction, apex, radius, tube radius, half angle (as in AnalyticSurface)
//           text name, i32 colour 0xRRGGBB or -1. Neighbours on one surface with one name and colour
//           are one face
//   u64     vertices, double x 3 each
//   u64     triangles, i32 x 3 each; then of each its face, i32
enum class Status : std::uint32_t { kRead, kSyntax, kNoShape, kTooLarge, kNotTessellated };

// False: the answer could not be written.
using ReadFunction = bool (*)(const Request* request, Write write, void* sink);

}  // namespace symcell::cad
