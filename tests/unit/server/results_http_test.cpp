// Results: formats, negotiation, caching, compression.
#include "server/http/gzip.hpp"
#include "tests/unit/server/http_fixture.hpp"
#include "tests/unit/server/raw_connection.hpp"

namespace symcell::server::test {
namespace {

std::string gunzip(const std::string& packed) {
  std::string bytes;
  GzipInflater inflater([&](std::string_view piece) {
    bytes.append(piece);
    return true;
  });
  EXPECT_TRUE(inflater.write(packed) && inflater.complete());
  return bytes;
}

class ResultsHttpTest : public HttpTest {
 protected:
  void SetUp() override {
    start();
    path_ = "/v1/jobs/" + std::string(submit()["id"]);
    ASSERT_TRUE(reaches(path_.substr(9), "succeeded"));
  }

  std::string path_;
};

TEST_F(ResultsHttpTest, TheFormatComesFromTheQueryOrFromAccept) {
  const auto standard = client().Get(path_ + "/cell");
  ASSERT_TRUE(standard);
  EXPECT_EQ(standard->status, 200);
  EXPECT_EQ(standard->get_header_value("Content-Type"), "application/vnd.vtk.vtu+xml");
  EXPECT_EQ(standard->get_header_value("Content-Disposition"), "attachment; filename=\"cell.vtu\"");
  const auto json = client().Get(path_ + "/full", {{"Accept", "application/json"}});
  ASSERT_TRUE(json);
  EXPECT_EQ(nlohmann::json::parse(json->body)["fold"], 6);
  const auto svg = client().Get(path_ + "/full?format=svg");
  ASSERT_TRUE(svg);
  EXPECT_EQ(svg->get_header_value("Content-Type"), "image/svg+xml");
  const auto msh = client().Get(path_ + "/cell?format=msh");
  ASSERT_TRUE(msh);
  EXPECT_TRUE(msh->body.starts_with("$MeshFormat"));
}

TEST_F(ResultsHttpTest, VtuEncodingsAreChosenByTheQuery) {
  const auto ascii = client().Get(path_ + "/cell?encoding=ascii");
  ASSERT_TRUE(ascii);
  EXPECT_NE(ascii->body.find("ascii"), std::string::npos);
  EXPECT_EQ(client().Get(path_ + "/cell?encoding=zlib")->status, 200);
  problem_of(client().Get(path_ + "/cell?encoding=rot13"), 400);
}

TEST_F(ResultsHttpTest, DecksTakeTheirOptionsFromTheQuery) {
  const auto plain = client().Get(path_ + "/full?format=inp");
  const auto modal = client().Get(path_ + "/full?format=inp&analysis=modal&material=steel");
  ASSERT_TRUE(plain && modal);
  EXPECT_EQ(plain->status, 200);
  EXPECT_EQ(plain->get_header_value("Content-Type"), "model/x-abaqus");
  EXPECT_EQ(modal->status, 200) << modal->body;
  EXPECT_NE(modal->body.find("*FREQUENCY"), std::string::npos);
  EXPECT_NE(plain->get_header_value("ETag"), modal->get_header_value("ETag"));
  // What follows the first "=" is the value, whatever is in it.
  problem_of(client().Get(path_ + "/full?format=inp&material=99=steel"), 400);
  problem_of(client().Get(path_ + "/full?format=inp&material=99%3Dsteel"), 400);
  // Before a byte is sent.
  problem_of(client().Get(path_ + "/full?format=inp&analysis=modal"), 400);
  problem_of(client().Get(path_ + "/full?format=inp&material=wood"), 400);
  problem_of(client().Get(path_ + "/full?format=vtu&material=steel"), 400);
  problem_of(client().Get(path_ + "/cell?format=inp&analysis=modal&material=steel"), 422);
  EXPECT_EQ(client().Head(path_ + "/cell?format=inp&analysis=modal&material=steel")->status, 422);
}

TEST_F(ResultsHttpTest, RawResultsHaveLengthsAndParts) {
  for (const char* end : {"/cell", "/full", "/statistics", "/model"}) {
    const auto whole = client().Get(path_ + end);
    ASSERT_TRUE(whole);
    const std::string bytes = whole->body;
    EXPECT_EQ(whole->get_header_value("Content-Length"), std::to_string(bytes.size())) << end;
    EXPECT_EQ(whole->get_header_value("Accept-Ranges"), "bytes");
    EXPECT_EQ(client().Head(path_ + end)->get_header_value("Content-Length"),
              std::to_string(bytes.size()));
    const auto part = [&](const std::string& range) {
      return client().Get(path_ + end, {{"Range", range}, {"Accept-Encoding", "gzip"}});
    };
    const std::string total = "/" + std::to_string(bytes.size());
    EXPECT_EQ(part("bytes=0-0")->body, bytes.substr(0, 1));
    EXPECT_EQ(part("bytes=3-11")->status, 206);
    EXPECT_EQ(part("bytes=3-11")->body, bytes.substr(3, 9));
    EXPECT_EQ(part("lines=1-2")->status, 200);
    EXPECT_EQ(part("Bytes=3-11")->status, 206);
    EXPECT_EQ(part("bytes=3-11")->get_header_value("Content-Range"), "bytes 3-11" + total);
    EXPECT_EQ(part("bytes=7-")->body, bytes.substr(7));
    EXPECT_EQ(part("bytes=-5")->body, bytes.substr(bytes.size() - 5));
    EXPECT_EQ(part("bytes=-999999999")->body, bytes);
    EXPECT_EQ(part("bytes=5-999999999")->body, bytes.substr(5));
    const auto beyond = part("bytes=999999999-");
    EXPECT_EQ(problem_of(beyond, 416)["code"], "range_not_satisfiable");
    EXPECT_EQ(beyond->get_header_value("Content-Range"), "bytes *" + total);
    EXPECT_EQ(part("bytes=0-1,4-5")->body, bytes);
    // What is malformed httplib refuses by itself.
    for (const char* other : {"bytes=9-3", "bytes=x-", "lines=0-1", "bytes=-"}) {
      EXPECT_NE(part(other)->status, 206) << other;
    }
  }
}

TEST_F(ResultsHttpTest, APartIsOfTheRepresentationThatTheClientHas) {
  const std::string etag = client().Get(path_ + "/cell")->get_header_value("ETag");
  const auto part = [&](const std::string& condition) {
    return client().Get(path_ + "/cell", {{"Range", "bytes=0-3"}, {"If-Range", condition}});
  };
  EXPECT_EQ(part(etag)->status, 206);
  EXPECT_EQ(part("\"another\"")->status, 200);
}

TEST_F(ResultsHttpTest, TextFormatsHaveNoParts) {
  const auto answer = client().Get(path_ + "/cell?format=json", {{"Range", "bytes=0-3"}});
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->get_header_value("Accept-Ranges"), "none");
}

TEST_F(ResultsHttpTest, WhatIsNotOfferedIsRefused) {
  problem_of(client().Get(path_ + "/cell?format=dxf"), 400);
  problem_of(client().Get(path_ + "/cell", {{"Accept", "image/png"}}), 406);
  // Surfaces are of solids; this mesh is planar.
  problem_of(client().Get(path_ + "/cell?format=stl"), 406);
  problem_of(client().Get(path_ + "/cell", {{"Accept", "model/stl"}}), 406);
  problem_of(client().Get(path_ + "/statistics", {{"Accept", "text/html"}}), 406);
}

TEST_F(ResultsHttpTest, AnUnchangedResultIsNotSentAgain) {
  const auto first = client().Get(path_ + "/cell");
  const std::string etag = first->get_header_value("ETag");
  EXPECT_TRUE(etag.starts_with('"'));
  const auto second = client().Get(path_ + "/cell", {{"If-None-Match", etag}});
  ASSERT_TRUE(second);
  EXPECT_EQ(second->status, 304);
  EXPECT_TRUE(second->body.empty());
  EXPECT_EQ(client().Get(path_ + "/full", {{"If-None-Match", etag}})->status, 200);
  EXPECT_NE(client().Get(path_ + "/cell?format=json")->get_header_value("ETag"), etag);
}

TEST_F(ResultsHttpTest, GzipHoldsTheSameBytesUnderAnotherTag) {
  auto plain_client = client();
  plain_client.set_decompress(false);
  for (const char* what : {"/cell?format=json", "/full", "/statistics", "/model"}) {
    const auto plain = plain_client.Get(path_ + what);
    const auto packed = plain_client.Get(path_ + what, {{"Accept-Encoding", "gzip"}});
    ASSERT_TRUE(plain && packed);
    EXPECT_EQ(packed->get_header_value("Content-Encoding"), "gzip");
    EXPECT_EQ(gunzip(packed->body), plain->body) << what;
    EXPECT_NE(packed->get_header_value("ETag"), plain->get_header_value("ETag"));
  }
}

TEST_F(ResultsHttpTest, HeadTellsTheSameHeadersWithoutABody) {
  const auto head = client().Head(path_ + "/cell?format=json");
  const auto get = client().Get(path_ + "/cell?format=json");
  ASSERT_TRUE(head && get);
  EXPECT_EQ(head->status, 200);
  EXPECT_TRUE(head->body.empty());
  for (const char* name : {"Content-Type", "ETag", "Content-Disposition"}) {
    EXPECT_EQ(head->get_header_value(name), get->get_header_value(name)) << name;
  }
}

TEST_F(ResultsHttpTest, OldClientsGetTheBodyWithoutChunks) {
  RawConnection connection(port());
  connection.send("GET " + path_ + "/statistics HTTP/1.0\r\n\r\n");
  const std::string answer = connection.receive_all();
  EXPECT_EQ(answer.find("chunked"), std::string::npos) << answer;
  EXPECT_TRUE(answer.ends_with("\r\n\r\n{\"cell\": {\"elements\": 12}}\n")) << answer;
}

// Cut off, with a bit turned, emptied, gone: nothing of it is sent.
TEST_F(ResultsHttpTest, DamagedFilesAreErrorsAndNoBrokenDownloads) {
  const std::string id = path_.substr(9);
  const JobFiles& files = service_->jobs().files();
  for (const auto& [name, file] :
       {std::pair<std::string, std::filesystem::path>{"/cell", files.cell(id)},
        {"/full", files.cell(id)},
        {"/statistics", files.statistics(id)},
        {"/model", files.model(id)}}) {
    const std::string whole = symcell::test::read_file(file);
    std::string turned = whole;
    turned[turned.size() / 2] = static_cast<char>(turned[turned.size() / 2] ^ 1);
    for (const std::string& damage :
         {whole.substr(0, whole.size() / 2), turned, std::string(), whole + " "}) {
      symcell::test::write_file(file, damage);
      EXPECT_EQ(problem_of(client().Get(path_ + name), 500)["code"], "stored_file_damaged")
          << name << damage.size();
    }
    std::filesystem::remove(file);
    EXPECT_EQ(problem_of(client().Get(path_ + name), 500)["code"], "stored_file_damaged") << name;
    if (name == "/statistics") {
      const auto document = job(id);
      EXPECT_TRUE(document["statistics"].is_null());
      EXPECT_EQ(document["damaged"][0], "statistics");
    }
    symcell::test::write_file(file, whole);
    EXPECT_EQ(client().Get(path_ + name)->status, 200) << name;
  }
  EXPECT_FALSE(job(id).contains("damaged"));
}

TEST_F(ResultsHttpTest, AModelThatWasDamagedWhileItWaitedIsNotMeshed) {
  engine_.close_gate();
  const std::string first = submit()["id"];
  ASSERT_TRUE(reaches(first, "running"));
  const std::string second = submit()["id"];
  symcell::test::write_file(service_->jobs().files().model(second), square_json() + " ");
  engine_.open_gate();
  ASSERT_TRUE(reaches(second, "failed"));
  EXPECT_NE(std::string(job(second)["error"]["detail"]).find("submit it again"), std::string::npos);
}

TEST_F(ResultsHttpTest, UnfinishedAndFailedJobsHaveNoResults) {
  engine_.close_gate();
  const std::string running = "/v1/jobs/" + std::string(submit()["id"]);
  const auto early = client().Get(running + "/cell");
  EXPECT_EQ(problem_of(early, 409)["code"], "not_finished");
  EXPECT_EQ(client().Get(running + "/model")->status, 200);
  client().Post(running + "/cancel");
  ASSERT_TRUE(reaches(running.substr(9), "cancelled"));
  EXPECT_EQ(problem_of(client().Get(running + "/statistics"), 409)["code"], "no_result");
}

}  // namespace
}  // namespace symcell::server::test
