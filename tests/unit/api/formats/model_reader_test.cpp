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
  EXPECT_EQ(model_format_from_name("b.STL.gz"), ModelFormat::kStl);
  EXPECT_EQ(model_format_from_name("b.smesh"), ModelFormat::kSmesh);
  EXPECT_EQ(model_format_from_name("b.STP"), ModelFormat::kStep);
  EXPECT_EQ(model_format_from_name("b.igs"), ModelFormat::kIges);
  EXPECT_FALSE(model_format_from_name("b.sldprt"));
  EXPECT_EQ(model_format_from_media_type("model/stl"), ModelFormat::kStl);
  EXPECT_EQ(model_format_from_media_type("application/sla"), ModelFormat::kStl);
  EXPECT_EQ(model_format_from_media_type("Model/OBJ"), ModelFormat::kObj);
  EXPECT_FALSE(model_format_from_media_type("application/octet-stream"));
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

// What read_model takes the bytes for.
std::optional<ModelFormat> recognised(std::string_view bytes,
                                      std::optional<ModelFormat> format = std::nullopt) {
  ModelFormat found{};
  const auto model = read_model(bytes, format, &found);
  EXPECT_TRUE(model) << (model ? "" : model.error().message);
  if (!model) return std::nullopt;
  EXPECT_EQ(kind_of(*model), model_format_info(found).kind);
  return found;
}

constexpr const char* kAsciiStl =
    "solid x\n facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 0 1 0\n"
    " endloop\n endfacet\nendsolid x\n";

// After a head of blanks a count of 60 is '<', one of 91 '[', one of 123 '{'.
TEST(ModelReader, BinaryStlIsToldWhateverItsCountLooksLike) {
  for (const std::string& head :
       {std::string(80, ' '), "ply\n" + std::string(76, ' '), "OFF " + std::string(76, '\n')}) {
    for (unsigned count = 1; count < 256; ++count) {
      std::string binary = head + std::string(4 + std::size_t{50} * count, '\0');
      binary[80] = static_cast<char>(count);
      EXPECT_EQ(recognised(binary), ModelFormat::kStl) << count;
    }
  }
}

TEST(ModelReader, SolidsAreToldFromContent) {
  EXPECT_EQ(recognised(kAsciiStl), ModelFormat::kStl);
  // A wrong name does not matter where the content is plain.
  EXPECT_EQ(recognised(kAsciiStl, ModelFormat::kPoly), ModelFormat::kStl);
  std::string binary(84 + 50, '\0');
  binary[80] = 1;
  EXPECT_EQ(recognised(binary), ModelFormat::kStl);
  EXPECT_EQ(recognised("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), ModelFormat::kOff);
  EXPECT_EQ(recognised("# obj\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), ModelFormat::kObj);
  const std::string vertices = "3 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n1 0\n";
  const std::string poly = vertices + "1 0 0\n3 1 2 3\n0\n0\n";
  const std::string smesh = vertices + "3 1 2 3\n0\n0\n";
  EXPECT_EQ(recognised(poly), ModelFormat::kTetgenPoly);
  EXPECT_EQ(recognised(poly, ModelFormat::kPoly), ModelFormat::kTetgenPoly);
  EXPECT_EQ(recognised(smesh), ModelFormat::kSmesh);
  EXPECT_EQ(recognised(smesh, ModelFormat::kSmesh), ModelFormat::kSmesh);
  EXPECT_EQ(recognised("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                       "property float y\nproperty float z\nelement face 1\n"
                       "property list uchar int vertex_indices\nend_header\n"
                       "0 0 0 1 0 0 0 1 0 3 0 1 2\n"),
            ModelFormat::kPly);
  EXPECT_EQ(recognised(R"({"vertices":[],"facets":[],"type":"plc"})"), ModelFormat::kPlcJson);
  EXPECT_EQ(recognised(R"({"type":"plc","vertices":[],"facets":[]})", ModelFormat::kStl),
            ModelFormat::kPlcJson);
  EXPECT_EQ(recognised(R"({"type":"pslg","vertices":[],"segments":[]})"), ModelFormat::kPslgJson);
}

TEST(ModelReader, StrangersAreNamed) {
  EXPECT_EQ(code_of("<html><body>404</body></html>"), ErrorCode::kUnknownFormat);
  EXPECT_EQ(code_of("<html><body>404</body></html>", ModelFormat::kStl), ErrorCode::kUnknownFormat);
  EXPECT_EQ(code_of("ISO-10303-21;\nHEADER;\n"), ErrorCode::kUnsupportedModel);
  EXPECT_EQ(code_of("\x7f"
                    "ELF\1\1\1"),
            ErrorCode::kUnknownFormat);
  EXPECT_EQ(code_of("hello"), ErrorCode::kUnknownFormat);
  EXPECT_EQ(code_of("hello", ModelFormat::kStl), ErrorCode::kUnknownFormat);
  EXPECT_EQ(code_of(""), ErrorCode::kEmptyFile);
  EXPECT_EQ(code_of(" \r\n"), ErrorCode::kEmptyFile);
}

// Every bad model of the corpus that a parser can refuse, refused as its manifest says.
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
                    std::pair{"b22_empty.stl", ErrorCode::kEmptyFile},
                    std::pair{"b24_truncated_binary.stl", ErrorCode::kTruncated},
                    std::pair{"b25_count_lies_4294967295.stl", ErrorCode::kCountMismatch},
                    std::pair{"b26_html_page.stl", ErrorCode::kUnknownFormat},
                    std::pair{"b30_nan_binary.stl", ErrorCode::kNonFinite}));

TEST(SharedData, PlanarCorpusIsRead) {
  const auto shared = test::shared_folder();
  if (!shared) GTEST_SKIP() << "../shared is absent";
  const auto manifest =
      nlohmann::json::parse(test::read_file(*shared / "corpus" / "manifest.json"));
  std::size_t read = 0;
  for (const auto& entry : manifest["files"]) {
    if (entry["kind"] != "pslg2d" || entry["valid"] == false) continue;
    const std::string file = entry["file"];
    const auto model = read_model(test::read_file(*shared / "corpus" / file), std::nullopt);
    ASSERT_TRUE(model) << file << ": " << model.error().message;
    const auto& pslg = std::get<Pslg>(*model);
    EXPECT_EQ(pslg.vertices.size(), entry["vertices"].get<std::size_t>()) << file;
    EXPECT_EQ(pslg.segments.size(), entry["segments"].get<std::size_t>()) << file;
    for (const auto& also : entry["also"]) {
      const std::string twin = also.is_string() ? also.get<std::string>() : also.value("file", "");
      if (!twin.ends_with(".poly")) continue;
      const auto other = read_model(test::read_file(*shared / "corpus" / twin), std::nullopt);
      ASSERT_TRUE(other) << twin << ": " << other.error().message;
      EXPECT_EQ(std::get<Pslg>(*other).vertices, pslg.vertices) << twin;
      EXPECT_EQ(std::get<Pslg>(*other).segments, pslg.segments) << twin;
    }
    ++read;
  }
  EXPECT_GE(read, 10U);
}

TEST(SharedData, SolidCorpusIsRead) {
  const auto shared = test::shared_folder();
  if (!shared) GTEST_SKIP() << "../shared is absent";
  const auto manifest =
      nlohmann::json::parse(test::read_file(*shared / "corpus" / "manifest.json"));
  std::size_t read = 0;
  for (const auto& entry : manifest["files"]) {
    const std::string kind = entry["kind"];
    if ((kind != "plc3d" && kind != "stl3d") || entry["valid"] == false) continue;
    const std::string file = entry["file"];
    const auto model = read_model(test::read_file(*shared / "corpus" / file), std::nullopt);
    ASSERT_TRUE(model) << file << ": " << model.error().message;
    ++read;
    if (kind == "stl3d") {
      EXPECT_EQ(std::get<TriangleSurface>(*model).triangles.size(),
                entry["triangles"].get<std::size_t>())
          << file;
      continue;
    }
    const auto& plc = std::get<Plc>(*model);
    EXPECT_EQ(plc.vertices.size(), entry["vertices"].get<std::size_t>()) << file;
    EXPECT_EQ(plc.facets.size(), entry["facets"].get<std::size_t>()) << file;
    for (const std::string twin : entry["also"]) {
      // Without a name, and by its name.
      for (const auto format : {std::optional<ModelFormat>(), model_format_from_name(twin)}) {
        const auto other = read_model(test::read_file(*shared / "corpus" / twin), format);
        ASSERT_TRUE(other) << twin << ": " << other.error().message;
        EXPECT_EQ(std::get<Plc>(*other).vertices, plc.vertices) << twin;
        EXPECT_EQ(std::get<Plc>(*other).facets, plc.facets) << twin;
        EXPECT_EQ(std::get<Plc>(*other).regions, plc.regions) << twin;
      }
    }
  }
  EXPECT_GE(read, 20U);
}

}  // namespace
}  // namespace symcell
