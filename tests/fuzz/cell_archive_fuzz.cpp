#include <zlib.h>

#include <cstring>
#include <string>

#include "api/formats/cell_archive.hpp"
#include "api/formats/mesh_writer.hpp"
#include "tests/fuzz/fuzz_support.hpp"

// The checksum is mended, so that the fuzzer gets behind it; what is read must then be safe to
// write in every format.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace symcell;
  std::string bytes(fuzz::text_of(data, size));
  if (bytes.size() > 4) {
    const auto crc = static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size() - 4));
    std::memcpy(bytes.data() + bytes.size() - 4, &crc, 4);
  }
  const auto cell = read_cell_archive(bytes);
  if (!cell) {
    fuzz::require_good_message(cell.error());
    return 0;
  }
  std::size_t left = 1 << 20;
  const Sink sink = [&](std::string_view piece) {
    left -= std::min(left, piece.size());
    return left > 0;
  };
  if (cell->fold > 1000) return 0;
  for (const MeshPart part : {MeshPart::kCell, MeshPart::kFull}) {
    for (const MeshFormat format : {MeshFormat::kJson, MeshFormat::kVtu, MeshFormat::kMsh,
                                    MeshFormat::kSvg, MeshFormat::kStl}) {
      left = 1 << 20;
      (void)write_mesh(*cell, part, format, {}, sink);
    }
  }
  return 0;
}
