#include "server/http/gzip.hpp"

#include <gtest/gtest.h>

#include "server/http/inflating_file.hpp"
#include "tests/support/test_files.hpp"

namespace symcell::server {
namespace {

using symcell::test::read_file;
using symcell::test::TemporaryFolder;

std::string deflate(const std::string& bytes) {
  std::string packed;
  GzipDeflater deflater([&](std::string_view piece) {
    packed.append(piece);
    return true;
  });
  EXPECT_TRUE(deflater.write(bytes));
  EXPECT_TRUE(deflater.finish());
  return packed;
}

TEST(GzipTest, BytesComeBackHoweverTheyAreCut) {
  std::string bytes;
  for (int i = 0; i < 50'000; ++i) bytes += std::to_string(i * 7919);
  const std::string packed = deflate(bytes);
  EXPECT_LT(packed.size(), bytes.size());
  for (const std::size_t step : {std::size_t{1}, std::size_t{1000}, packed.size()}) {
    std::string unpacked;
    GzipInflater inflater([&](std::string_view piece) {
      unpacked.append(piece);
      return true;
    });
    for (std::size_t at = 0; at < packed.size(); at += step) {
      ASSERT_TRUE(inflater.write(std::string_view(packed).substr(at, step)));
    }
    EXPECT_TRUE(inflater.complete());
    EXPECT_EQ(unpacked, bytes);
  }
}

TEST(GzipTest, CutOffAndDamagedStreamsAreSeen) {
  const std::string packed = deflate(std::string(10'000, 'a'));
  const auto ignore = [](std::string_view) { return true; };
  GzipInflater cut(ignore);
  EXPECT_TRUE(cut.write(std::string_view(packed).substr(0, packed.size() - 1)));
  EXPECT_FALSE(cut.complete());
  GzipInflater plain(ignore);
  EXPECT_FALSE(plain.write("this is not gzip"));
  GzipInflater longer(ignore);
  EXPECT_FALSE(longer.write(packed + "more"));
}

TEST(GzipTest, AcceptEncodingIsReadWithItsWeights) {
  EXPECT_TRUE(accepts_gzip("gzip"));
  EXPECT_TRUE(accepts_gzip("br, GZIP;q=0.5"));
  EXPECT_TRUE(accepts_gzip("*"));
  EXPECT_FALSE(accepts_gzip("gzip;q=0"));
  EXPECT_FALSE(accepts_gzip("*, gzip;q=0"));
  EXPECT_FALSE(accepts_gzip("br"));
  EXPECT_FALSE(accepts_gzip(""));
}

TEST(InflatingFileTest, PlainBytesAreStoredAsTheyAre) {
  const TemporaryFolder folder;
  InflatingFile file(folder / "model", 100);
  EXPECT_TRUE(file.add("{"));
  EXPECT_TRUE(file.add("}"));
  EXPECT_TRUE(file.finish());
  EXPECT_EQ(read_file(folder / "model"), "{}");
}

TEST(InflatingFileTest, AGzipFileIsUnpackedEvenByteByByte) {
  const TemporaryFolder folder;
  InflatingFile file(folder / "model", 100);
  for (const char c : deflate("hello")) EXPECT_TRUE(file.add({&c, 1}));
  EXPECT_TRUE(file.finish());
  EXPECT_EQ(read_file(folder / "model"), "hello");
}

TEST(InflatingFileTest, ABombStopsAtTheBound) {
  const TemporaryFolder folder;
  InflatingFile file(folder / "model", 1000);
  EXPECT_FALSE(file.add(deflate(std::string(10'000'000, 'a'))));
  EXPECT_EQ(file.fault(), InflatingFile::Fault::kTooLarge);
}

TEST(InflatingFileTest, ACutOffFileIsDamagedAndGoesAway) {
  const TemporaryFolder folder;
  {
    InflatingFile file(folder / "model", 1000);
    const std::string packed = deflate("hello");
    EXPECT_TRUE(file.add(packed.substr(0, packed.size() - 2)));
    EXPECT_FALSE(file.finish());
    EXPECT_EQ(file.fault(), InflatingFile::Fault::kDamaged);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "model"));
}

TEST(InflatingFileTest, TheBoundHoldsForPlainBytesToo) {
  const TemporaryFolder folder;
  InflatingFile file(folder / "model", 3);
  EXPECT_FALSE(file.add("four"));
  EXPECT_EQ(file.fault(), InflatingFile::Fault::kTooLarge);
}

}  // namespace
}  // namespace symcell::server
