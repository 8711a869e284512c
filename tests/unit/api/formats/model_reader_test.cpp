#include "api/formats/model_reader.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <nlohmann/json.hpp>

#include "tests/support/test_files.hpp"

namespace symcell {
namespace {

ErrorCode code_of(std::string_view bytes, std::optional<ModelFormat> format = std::nullopt) {
  const auto model = read_model(bytes, format);
  EXPECT_FALSE(model.has_value());
  return model ? ErrorCode::kInternal : model.error().code;
}

TEST(ModelReader, FormatsByNameAndMediaType) {
  EXPECT_EQ(model_format_from_name("a/b.JSON"), ModelFormat::kPslgJson);
  EXPECT_EQ(model_format_from_name("b.poly.gz"), ModelFormat::kPoly);
  EXPECT_FALSE(model_format_from_name("b.stl"));
  EXPECT_EQ(model_format_from_media_type("application/json; charset=utf-8"),
            ModelFormat::kPslgJson);
  EXPECT_FALSE(model_format_from_media_type("text/plain"));
}

TEST(ModelReader, TellsFormatsFromContent) {
  EXPECT_TRUE(read_model(" \n{\"type\":\"pslg\",\"vertices\":[],\"segments\":[]}", std::nullopt));
  EXPECT_TRUE(
      read_model("\xef\xbb\xbf{\"type\":\"pslg\",\"vertices\":[],\"segments\":[]}", std::nullopt));
  EXPECT_TRUE(read_model("# poly\n1 2 0 0\n1 0 0\n0 0\n0\n", std::nullopt));
  // A wrong name does not matter where the content is plain.
  EXPECT_TRUE(
      read_model("{\"type\":\"pslg\",\"vertices\":[],\"segments\":[]}", ModelFormat::kPoly));
}

TEST(ModelReader, SolidsAndStrangersAreNamed) {
  EXPECT_EQ(code_of("solid x\n facet normal 0 0 1\n"), ErrorCode::kUnsupportedModel);
  EXPECT_EQ(code_of("solid x\n facet normal 0 0 1\n", ModelFormat::kPoly),
            ErrorCode::kUnsupportedModel);
  std::string binary(84 + 50, '\0');
  binary[80] = 1;
  EXPECT_EQ(code_of(binary), ErrorCode::kUnsupportedModel);
  EXPECT_EQ(code_of("OFF\n3 1 0\n"), ErrorCode::kUnsupportedModel);
  EXPECT_EQ(code_of("# obj\nv 0 0 0\n"), ErrorCode::kUnsupportedModel);
  EXPECT_EQ(code_of("<html><body>404</body></html>"), ErrorCode::kUnknownFormat);
  EXPECT_EQ(code_of("\x7f"
                    "ELF\1\1\1"),
            ErrorCode::kUnknownFormat);
  EXPECT_EQ(code_of("hello"), ErrorCode::kUnknownFormat);
  EXPECT_EQ(code_of(""), ErrorCode::kEmptyFile);
  EXPECT_EQ(code_of(" \r\n"), ErrorCode::kEmptyFile);
}

// Every planar bad model of the corpus that a parser can refuse, refused as its manifest says.
class BadModel : public testing::TestWithParam<std::pair<const char*, ErrorCode>> {};

TEST_P(BadModel, EndsInItsClass) {
  const auto& [name, code] = GetParam();
  const std::string path = std::string("models/") + name;
  EXPECT_EQ(code_of(test::read_file(test::data_file(path)), model_format_from_name(name)), code);
}

INSTANTIATE_TEST_SUITE_P(
    Corpus,
    BadModel,
    testing::Values(std::pair{"b04_nan_token.json", ErrorCode::kNonFinite},
                    std::pair{"b05_inf_1e999.json", ErrorCode::kNonFinite},
                    std::pair{"b10_json_cut_off.json", ErrorCode::kJsonSyntax},
                    std::pair{"b12_wrong_types.json", ErrorCode::kWrongType},
                    std::pair{"b20_poly_header_lies.poly", ErrorCode::kCountMismatch},
                    std::pair{"b21_empty.json", ErrorCode::kEmptyFile},
                    std::pair{"b26_html_page.stl", ErrorCode::kUnknownFormat},
                    std::pair{"b33_plc_nonplanar_facets_n3.json", ErrorCode::kUnsupportedModel}));

TEST(ModelReader, CorpusBesideTheTree) {
  const auto shared = test::shared_folder();
  if (!shared) GTEST_SKIP() << "the corpus is not beside the source tree";
  const auto manifest =
      nlohmann::json::parse(test::read_file(*shared / "corpus" / "manifest.json"));
  std::size_t read = 0;
  for (const auto& entry : manifest["files"]) {
    if (entry["kind"] != "pslg2d" || entry["valid"] == false) continue;
    const std::string file = entry["file"];
    const auto model = read_model(test::read_file(*shared / "corpus" / file), std::nullopt);
    ASSERT_TRUE(model) << file << ": " << model.error().message;
    EXPECT_EQ(model->vertices.size(), entry["vertices"].get<std::size_t>()) << file;
    EXPECT_EQ(model->segments.size(), entry["segments"].get<std::size_t>()) << file;
    for (const auto& also : entry["also"]) {
      const std::string twin = also.is_string() ? also.get<std::string>() : also.value("file", "");
      if (!twin.ends_with(".poly")) continue;
      const auto other = read_model(test::read_file(*shared / "corpus" / twin), std::nullopt);
      ASSERT_TRUE(other) << twin << ": " << other.error().message;
      EXPECT_EQ(other->vertices, model->vertices) << twin;
      EXPECT_EQ(other->segments, model->segments) << twin;
    }
    ++read;
  }
  EXPECT_GE(read, 10U);
}

}  // namespace
}  // namespace symcell
