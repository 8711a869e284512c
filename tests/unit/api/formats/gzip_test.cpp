#include "api/formats/gzip.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include "api/formats/model_reader.hpp"

namespace symcell {
namespace {

std::string gzip(const std::string& text) {
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, text.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(packed.size() - stream.avail_out);
  deflateEnd(&stream);
  return packed;
}

TEST(Gzip, UnpacksMembersOneAfterTheOther) {
  const std::string text(300000, 'x');
  EXPECT_EQ(gunzip(gzip(text), 1 << 20).value(), text);
  EXPECT_EQ(gunzip(gzip("a") + gzip("b"), 10).value(), "ab");
  EXPECT_EQ(gunzip(gzip(""), 10).value(), "");
}

TEST(Gzip, IsBounded) {
  EXPECT_EQ(gunzip(gzip(std::string(1 << 20, '0')), 1000).error().code, ErrorCode::kTooLarge);
}

TEST(Gzip, DamageIsTold) {
  const std::string packed = gzip("some text that is long enough to be cut");
  for (std::size_t size = 2; size < packed.size(); ++size) {
    const auto text = gunzip(packed.substr(0, size), 1000);
    ASSERT_FALSE(text) << size;
    EXPECT_EQ(text.error().code, ErrorCode::kTruncated) << size;
  }
  std::string damaged = packed;
  damaged[packed.size() - 6] ^= 1;
  EXPECT_EQ(gunzip(damaged, 1000).error().code, ErrorCode::kSyntax);
}

TEST(Gzip, ModelsMayBePacked) {
  const std::string model = R"({"type":"pslg","vertices":[[1,2]],"segments":[]})";
  EXPECT_EQ(std::get<Pslg>(read_model(gzip(model), std::nullopt).value()).vertices.size(), 1U);
  EXPECT_EQ(read_model(gzip(gzip(model)), std::nullopt).error().code, ErrorCode::kUnknownFormat);
}

}  // namespace
}  // namespace symcell
