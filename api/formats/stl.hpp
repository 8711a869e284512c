// STL, ASCII and binary. Normals, colours and names are not looked at; several `solid` blocks are
// one surface. Every triangle has three vertices of its own.
#pragma once

#include <string_view>

#include "core/base/error.hpp"
#include "core/model/triangle_surface.hpp"

namespace symcell {

// Binary and ASCII are told apart by the content, not by a leading "solid".
// Errors: kTruncated, kCountMismatch (binary: the header's count), kSyntax (with the line),
// kNonFinite (names the triangle, from 0), kUnknownFormat (no STL), kTooLarge, kDegenerateGeometry
// (no triangles at all).
[[nodiscard]] Result<TriangleSurface> read_stl(std::string_view bytes);

// Whether the size is what a binary STL's count asks for. No text is: its count would be of a file of 7 GB
// and more.
[[nodiscard]] bool has_size_of_binary_stl(std::string_view bytes);

// Whether bytes of unknown format are a binary STL: its count fits its size, or the head looks
// like one though the count is wrong.
[[nodiscard]] bool looks_like_binary_stl(std::string_view bytes);

namespace internal {
[[nodiscard]] Result<TriangleSurface> read_ascii_stl(std::string_view bytes);
}

}  // namespace symcell
