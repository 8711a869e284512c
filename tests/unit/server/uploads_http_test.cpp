// Every way to send a model, and every way to send it wrongly.
#include "server/http/gzip.hpp"
#include "tests/unit/server/http_fixture.hpp"
#include "tests/unit/server/raw_connection.hpp"

namespace symcell::server::test {
namespace {

std::string gzip(const std::string& bytes) {
  std::string packed;
  GzipDeflater deflater([&](std::string_view piece) {
    packed.append(piece);
    return true;
  });
  EXPECT_TRUE(deflater.write(bytes) && deflater.finish());
  return packed;
}

std::string chunked(const std::string& body, std::size_t step) {
  std::string text;
  for (std::size_t at = 0; at < body.size(); at += step) {
    const std::string piece = body.substr(at, step);
    std::array<char, 20> size{};
    std::snprintf(size.data(), size.size(), "%zx", piece.size());
    text += std::string(size.data()) + "\r\n" + piece + "\r\n";
  }
  return text + "0\r\n\r\n";
}

class UploadsHttpTest : public HttpTest {
 protected:
  [[nodiscard]] std::string exchange(const std::string& request) const {
    RawConnection connection(port());
    connection.send(request);
    return connection.receive_all();
  }
};

TEST_F(UploadsHttpTest, ARawModelTakesItsOptionsFromTheQuery) {
  for (const char* type :
       {"application/octet-stream", "text/plain", "application/x-www-form-urlencoded"}) {
    const auto answer = client().Post("/v1/jobs?min_angle=20", square_json(), type);
    ASSERT_TRUE(answer) << type;
    EXPECT_EQ(answer->status, 202) << answer->body;
    EXPECT_EQ(nlohmann::json::parse(answer->body)["options"]["min_angle"], 20);
    ASSERT_TRUE(reaches(nlohmann::json::parse(answer->body)["id"], "succeeded"));
  }
}

TEST_F(UploadsHttpTest, ABareModelAsJsonTakesItsOptionsFromTheQuery) {
  const auto answer = client().Post("/v1/jobs?fold=4", square_json(), "application/json");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 202) << answer->body;
}

TEST_F(UploadsHttpTest, AFormCarriesModelAndOptions) {
  const httplib::MultipartFormDataItems form{
      {"model", square_json(), "dir/square.json", "application/json"},
      {"options", "{\"fold\":4}", "", "application/json"}};
  const auto answer = client().Post("/v1/jobs", form);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->status, 202) << answer->body;
  const auto document = nlohmann::json::parse(answer->body);
  EXPECT_EQ(document["model"]["name"], "square.json");
  EXPECT_EQ(document["options"]["fold"], 4);
  const auto model = client().Get("/v1/jobs/" + std::string(document["id"]) + "/model");
  EXPECT_EQ(model->body, square_json());
}

TEST_F(UploadsHttpTest, AFormsModelMayBeAsLargeAsAnyOther) {
  const std::string largest = std::string((1UL << 20U) - square_json().size(), ' ') + square_json();
  const httplib::MultipartFormDataItems fits{{"model", largest, "a.json", ""}};
  EXPECT_EQ(client().Post("/v1/jobs", fits)->status, 202);
  const httplib::MultipartFormDataItems too_large{{"model", largest + " ", "a.json", ""}};
  problem_of(client().Post("/v1/jobs", too_large), 413);
}

TEST_F(UploadsHttpTest, FaultyFormsAreToldWhy) {
  const httplib::MultipartFormDataItems no_model{{"options", "{}", "", ""}};
  EXPECT_EQ(problem_of(client().Post("/v1/jobs", no_model), 400)["code"], "missing_field");
  const httplib::MultipartFormDataItems unknown{{"modell", square_json(), "a.json", ""}};
  EXPECT_EQ(problem_of(client().Post("/v1/jobs", unknown), 400)["code"], "bad_request");
  problem_of(client().Post("/v1/jobs", "no form at all", "multipart/form-data; boundary=x"), 400);
  problem_of(client().Post("/v1/jobs", "no boundary", "multipart/form-data"), 400);
  const httplib::MultipartFormDataItems bad_options{{"model", square_json(), "a.json", ""},
                                                    {"options", "{\"fold\":", "", ""}};
  EXPECT_EQ(problem_of(client().Post("/v1/jobs", bad_options), 400)["code"], "json_syntax");
}

TEST_F(UploadsHttpTest, MalformedModelsAndOptionsAreRefusedAtOnce) {
  struct Case {
    std::string body;
    const char* code;
  };
  const Case cases[] = {{"", "empty_file"},
                        {"{", "json_syntax"},
                        {"[]", "wrong_type"},
                        {"{\"options\":{}}", "missing_field"},
                        {job_body("{\"no_such\":1}"), "bad_option"},
                        {job_body("{\"fold\":0}"), "bad_fold"},
                        {job_body("[]"), "wrong_type"},
                        {job_body("[[[[[[[[]]]]]]]]"), "bad_option"},
                        {"{\"model\":{\"type\":\"pslg\"}}", "missing_field"}};
  for (const Case& wrong : cases) {
    const auto problem = problem_of(client().Post("/v1/jobs", wrong.body, "application/json"), 400);
    EXPECT_EQ(problem["code"], wrong.code) << wrong.body;
  }
  EXPECT_EQ(engine_.runs(), 0);
}

TEST_F(UploadsHttpTest, OptionsInTwoPlacesAreRefused) {
  problem_of(client().Post("/v1/jobs?fold=3", job_body("{\"fold\":4}"), "application/json"), 400);
}

TEST_F(UploadsHttpTest, UnknownMediaTypesAndCodingsAreRefused) {
  const auto image = client().Post("/v1/jobs", square_json(), "image/png");
  EXPECT_EQ(problem_of(image, 415)["code"], "unsupported_media_type");
  EXPECT_FALSE(image->get_header_value("Accept-Post").empty());
  const auto brotli =
      client().Post("/v1/jobs", {{"Content-Encoding", "br"}}, square_json(), "text/plain");
  problem_of(brotli, 415);
}

TEST_F(UploadsHttpTest, GzippedBodiesAndModelsAreUnpacked) {
  const auto coded = client().Post("/v1/jobs", {{"Content-Encoding", "gzip"}}, gzip(job_body()),
                                   "application/json");
  ASSERT_TRUE(coded);
  EXPECT_EQ(coded->status, 202) << coded->body;
  const auto file = client().Post("/v1/jobs", gzip(square_json()), "application/octet-stream");
  ASSERT_TRUE(file);
  ASSERT_EQ(file->status, 202) << file->body;
  const std::string id = nlohmann::json::parse(file->body)["id"];
  EXPECT_EQ(client().Get("/v1/jobs/" + id + "/model")->body, square_json());
}

TEST_F(UploadsHttpTest, FaultyGzipIsRefused) {
  const std::string packed = gzip(job_body());
  const httplib::Headers coding{{"Content-Encoding", "gzip"}};
  problem_of(client().Post("/v1/jobs", coding, job_body(), "application/json"), 400);
  problem_of(
      client().Post("/v1/jobs", coding, packed.substr(0, packed.size() / 2), "application/json"),
      400);
  const auto bomb =
      client().Post("/v1/jobs", coding, gzip(std::string(50'000'000, ' ')), "application/json");
  EXPECT_EQ(problem_of(bomb, 413)["code"], "body_too_large");
}

TEST_F(UploadsHttpTest, DeclaredLengthsBeyondTheLimitAreRefusedUnread) {
  const std::string answer = exchange(
      "POST /v1/jobs HTTP/1.1\r\nHost: x\r\nContent-Type: text/plain\r\n"
      "Content-Length: 99999999999\r\n\r\n");
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 413 ")) << answer;
  EXPECT_NE(answer.find("Connection: close"), std::string::npos) << answer;
}

TEST_F(UploadsHttpTest, ChunkedBodiesAreCountedAndTaken) {
  const std::string head =
      "POST /v1/jobs HTTP/1.1\r\nHost: x\r\nConnection: close\r\nContent-Type: text/plain\r\n"
      "Transfer-Encoding: chunked\r\n\r\n";
  const std::string taken = exchange(head + chunked(square_json(), 7));
  EXPECT_TRUE(taken.starts_with("HTTP/1.1 202 ")) << taken;
  const std::string refused = exchange(head + chunked(std::string(2'000'000, ' '), 50'000));
  EXPECT_TRUE(refused.starts_with("HTTP/1.1 413 ")) << refused;
  const std::string broken = exchange(head + "zz\r\nhello\r\n");
  EXPECT_TRUE(broken.starts_with("HTTP/1.1 400 ")) << broken;
}

TEST_F(UploadsHttpTest, ALongBodyWithoutContentTypeIsTaken) {
  const std::string body = std::string(20'000, ' ') + square_json();
  const std::string answer = exchange(
      "POST /v1/jobs HTTP/1.1\r\nHost: x\r\nConnection: close\r\n"
      "Content-Length: " +
      std::to_string(body.size()) + "\r\n\r\n" + body);
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 202 ")) << answer;
}

TEST_F(UploadsHttpTest, NothingIsLeftOfRefusedUploads) {
  problem_of(client().Post("/v1/jobs", "{", "application/json"), 400);
  problem_of(client().Post("/v1/jobs", std::string(2'000'000, ' '), "text/plain"), 413);
  ASSERT_TRUE(reaches(submit()["id"], "succeeded"));
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "incoming"));
}

TEST_F(UploadsHttpTest, InspectAnswersAtOnce) {
  const auto answer = client().Post("/v1/inspect", square_json(), "application/json");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200) << answer->body;
  EXPECT_EQ(nlohmann::json::parse(answer->body)["bytes"], square_json().size());
  engine_.fail_with({ErrorCode::kNotSymmetric, "no", {}, ""});
  problem_of(client().Post("/v1/inspect", square_json(), "application/json"), 422);
}

}  // namespace
}  // namespace symcell::server::test
