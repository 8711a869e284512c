#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "api/formats/vtu_reader.hpp"
#include "tests/support/test_files.hpp"

namespace symcell {
namespace {

using Json = nlohmann::json;

class Cli : public testing::Test {
 protected:
  struct Outcome {
    int exit_code;
    std::string out;
    std::string err;
  };

  // `arguments` as in a shell; `before` is put in front, for pipes.
  Outcome symcell(const std::string& arguments, const std::string& before = "") {
    const std::string out = (folder_ / "stdout").string();
    const std::string err = (folder_ / "stderr").string();
    const std::string command =
        before + SYMCELL_PROGRAM + " " + arguments + " > " + out + " 2> " + err;
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), test::read_file(out), test::read_file(err)};
  }

  static std::string model(const std::string& name) {
    return test::data_file("models/" + name).string();
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  test::TemporaryFolder folder_;
  const std::string ring_ = model("p2_10_heptagon_ring_coarse_n7.json");
};

TEST_F(Cli, MeshesVerifiesAndTellsFigures) {
  const Outcome mesh = symcell("mesh " + ring_ + " --cell " + file("c.vtu") + " --full " +
                               file("f.vtu") + " --stats " + file("s.json"));
  EXPECT_EQ(mesh.exit_code, 0) << mesh.err;
  EXPECT_EQ(mesh.out, "");
  EXPECT_EQ(mesh.err, "");  // no progress bar in a pipe
  const Json stats = Json::parse(test::read_file(file("s.json")));
  EXPECT_EQ(stats["symmetry"]["fold"], 7);
  const auto cell = read_vtu(test::read_file(file("c.vtu")));
  ASSERT_TRUE(cell);
  EXPECT_EQ(cell->element_count(), stats["cell"]["elements"]);

  const std::string meshes = file("c.vtu") + " --full " + file("f.vtu");
  const Outcome verify = symcell("verify " + meshes + " --model " + ring_ + " --json");
  EXPECT_EQ(verify.exit_code, 0) << verify.out;
  EXPECT_EQ(Json::parse(verify.out)["ok"], true);

  const Outcome other =
      symcell("verify " + meshes + " --model " + model("p2_01_star_n5_tip12deg.json"));
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.out.find("fail  model.vertices"), std::string::npos) << other.out;
}

TEST_F(Cli, FormatsFromEndings) {
  for (const char* name : {"c.vtu", "c.json", "c.msh", "c.svg"}) {
    const Outcome mesh = symcell("mesh " + ring_ + " --order 2 --cell " + file(name));
    EXPECT_EQ(mesh.exit_code, 0) << mesh.err;
    EXPECT_GT(test::read_file(file(name)).size(), 500U) << name;
  }
  EXPECT_EQ(symcell("mesh " + ring_ + " --cell " + file("c.stl")).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(file("c.stl")));
}

TEST_F(Cli, SolidsAreMeshedWrittenAndVerified) {
  const std::string nut = model("p3_01_hexnut_n6.poly");
  for (const char* name : {"c.vtu", "c.json", "c.msh", "c.stl"}) {
    const Outcome mesh = symcell("mesh " + nut + " --order 2 --cell " + file(name));
    EXPECT_EQ(mesh.exit_code, 0) << mesh.err;
    EXPECT_GT(test::read_file(file(name)).size(), 500U) << name;
  }
  EXPECT_EQ(symcell("mesh " + nut + " --cell " + file("c.svg")).exit_code, 2);
  const Outcome verify = symcell("verify " + file("c.vtu") + " --model " + nut);
  EXPECT_EQ(verify.exit_code, 0) << verify.out;
  EXPECT_NE(verify.out.find("pass  model.volume"), std::string::npos) << verify.out;
  const Outcome other =
      symcell("verify " + file("c.vtu") + " --model " + model("p3_03_antiprism_n7_skew.json"));
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.out.find("fail  model.boundary"), std::string::npos) << other.out;
  EXPECT_EQ(symcell("verify " + file("c.vtu") + " --model " + ring_).exit_code, 1);
}

TEST_F(Cli, StandardStreams) {
  const Outcome json = symcell("mesh - --full - --format json", "cat " + ring_ + " | ");
  EXPECT_EQ(json.exit_code, 0) << json.err;
  EXPECT_EQ(Json::parse(json.out)["fold"], 7);
  const Outcome vtu = symcell("mesh " + ring_ + " --cell -");
  EXPECT_TRUE(read_vtu(vtu.out));
  const Outcome figures = symcell("mesh " + ring_);
  EXPECT_TRUE(Json::parse(figures.out).contains("cell"));
  EXPECT_EQ(symcell("mesh " + ring_ + " --cell - --stats -").exit_code, 2);
}

TEST_F(Cli, SameInputAndOptionsSameBytes) {
  const std::string mesh = "mesh " + model("p2_08_yinyang_n2_segment_through_centre.json") +
                           " --max-area 0.5 --full - --format json";
  EXPECT_EQ(symcell(mesh).out, symcell(mesh).out);
}

TEST_F(Cli, InspectsWithoutMeshing) {
  const Outcome found = symcell("inspect " + ring_);
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(Json::parse(found.out)["fold"], 7);
}

TEST_F(Cli, MeshesSolids) {
  const std::pair<const char*, int> folds[] = {{"p3_01_hexnut_n6.poly", 6},
                                               {"p3_02_starprism_n5_tip12deg.smesh", 5},
                                               {"p3_03_antiprism_n7_skew.json", 7}};
  for (const auto& [name, fold] : folds) {
    const Outcome found = symcell("inspect " + model(name));
    ASSERT_EQ(found.exit_code, 0) << found.err;
    EXPECT_EQ(Json::parse(found.out)["fold"], fold);
    const Outcome mesh =
        symcell("mesh " + model(name) + " --cell " + file("c.vtu") + " --stats " + file("s.json"));
    ASSERT_EQ(mesh.exit_code, 0) << mesh.err;
    const Json stats = Json::parse(test::read_file(file("s.json")));
    EXPECT_EQ(stats["symmetry"]["fold"], fold);
    EXPECT_GT(stats["cell"]["volume"], 0);
    EXPECT_FALSE(stats["cell"].contains("area"));
    EXPECT_EQ(stats["settings"]["radius_edge"], 1.414);
    EXPECT_TRUE(stats["settings"]["min_angle"].is_null());
  }
}

// Boxes whose triangles face inwards, all of them or every third: turned round, and reported.
TEST_F(Cli, RepairsOfSurfacesAreTold) {
  for (const char* name : {"b28_inside_out.stl", "b29_mixed_orientation.stl"}) {
    const Outcome mesh =
        symcell("mesh " + model(name) + " --fold 4 --axis-origin 0,0,0 --axis-direction 0,0,1");
    ASSERT_EQ(mesh.exit_code, 0) << mesh.err;
    const Json stats = Json::parse(mesh.out);
    EXPECT_FALSE(stats["repairs"].empty()) << name;
    EXPECT_NEAR(stats["cell"]["volume"].get<double>() * 4, 32, 1e-6);
  }
}

TEST_F(Cli, WarningsAreToldAndStrictRefusesThem) {
  const std::string box = model("b28_inside_out.stl");
  const Outcome mesh = symcell("mesh " + box + " --fold 4 --cell " + file("c.vtu") + " --stats -");
  ASSERT_EQ(mesh.exit_code, 0) << mesh.err;
  EXPECT_NE(mesh.err.find("symcell: warning: the surface was repaired"), std::string::npos);
  EXPECT_EQ(Json::parse(mesh.out)["warnings"].back()["code"], "surface_repaired");
  const Outcome found = symcell("inspect " + box + " --json-errors");
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(Json::parse(found.err)["warnings"], Json::parse(found.out)["warnings"]);

  for (const std::string& command :
       {"mesh " + box + " --cell " + file("d.vtu"), "inspect " + box}) {
    const Outcome strict = symcell(command + " --strict");
    EXPECT_EQ(strict.exit_code, 3);
    EXPECT_EQ(strict.out, "");
    EXPECT_NE(strict.err.find("surface_repaired"), std::string::npos) << strict.err;
    EXPECT_NE(strict.err.find("code strict_warnings"), std::string::npos) << strict.err;
  }
  EXPECT_FALSE(std::filesystem::exists(file("d.vtu")));
  EXPECT_EQ(symcell("mesh " + ring_ + " --strict").exit_code, 0);
}

TEST_F(Cli, ExitCodes) {
  const std::pair<std::string, int> cases[] = {
      {"", 2},
      {"nonsense", 2},
      {"mesh", 2},
      {"mesh " + ring_ + " --no-such-option", 2},
      {"mesh " + ring_ + " --fold 0", 2},
      {"mesh " + ring_ + " --fold -3", 2},
      {"mesh " + ring_ + " --fold 2.5", 2},
      {"mesh " + ring_ + " --fold four", 2},
      {"mesh " + ring_ + " --min-angle 43", 2},
      {"mesh " + ring_ + " --radius-edge 2", 2},
      {"mesh " + model("p3_03_antiprism_n7_skew.json") + " --min-angle 20", 2},
      {"mesh " + model("p3_03_antiprism_n7_skew.json") + " --cell " + file("c.svg"), 2},
      {"mesh " + model("b27_axis_zero_vector.stl") + " --axis-direction 0,0,0", 2},
      {"mesh " + model("b27_axis_zero_vector.stl") + " --axis-direction 0,1", 2},
      {"mesh " + model("b23_open_symmetric.stl"), 3},
      {"mesh " + model("b24_truncated_binary.stl"), 3},
      {"mesh " + model("b31_interpenetrating_boxes.stl") + " --repair none", 3},
      {"mesh " + model("b31_interpenetrating_boxes.stl") + " --strict", 3},
      {"mesh " + model("b33_plc_nonplanar_facets_n3.json"), 3},
      {"mesh " + ring_ + " --seed 1 --seed 2", 2},
      {"mesh /nowhere/model.json", 3},
      {"mesh " + model("b01_star5_declared_6.json") + " --fold 6", 3},
      {"mesh " + model("b21_empty.json"), 3},
      {"mesh " + model("b26_html_page.stl"), 3},
      {"mesh " + ring_ + " --max-elements 3", 4},
      {"mesh " + ring_ + " --max-area 1e-30", 4},
      {"mesh " + ring_ + " --cell /nowhere/cell.vtu", 1},
      {"verify " + ring_, 3},
      {"--help", 0},
      {"mesh --help", 0},
      {"inspect --help", 0},
      {"verify --help", 0},
      {"--version", 0}};
  for (const auto& [arguments, code] : cases) {
    const Outcome outcome = symcell(arguments);
    EXPECT_EQ(outcome.exit_code, code) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.err.empty(), code == 0) << arguments;
    EXPECT_TRUE(code == 0 || outcome.err.starts_with("symcell: ")) << arguments << outcome.err;
  }
}

TEST_F(Cli, ErrorsAsProblemDocuments) {
  const Outcome outcome = symcell("mesh " + model("b07_index_negative.json") +
                                  " --json-errors --cell " + file("c.vtu"));
  EXPECT_EQ(outcome.exit_code, 3);
  const Json problem = Json::parse(outcome.err);
  EXPECT_EQ(problem["code"], "index_out_of_range");
  EXPECT_EQ(problem["errors"][0]["pointer"], "/model/segments/5");
}

TEST_F(Cli, FailedRunsLeaveOldFilesAndNoNewOnes) {
  test::write_file(file("c.vtu"), "old");
  EXPECT_EQ(symcell("mesh " + ring_ + " --max-elements 3 --cell " + file("c.vtu")).exit_code, 4);
  EXPECT_EQ(test::read_file(file("c.vtu")), "old");
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    (void)entry;
    ++files;
  }
  EXPECT_EQ(files, 3U);  // the old one, standard output and error
}

TEST_F(Cli, GatesFailTheRunAndAreReported) {
  const std::string reports = " --report " + file("r.json") + " --junit " + file("j.xml");
  const Outcome good =
      symcell("mesh " + ring_ + " --fail-on 'cell.elements>1e6,warnings>0' --cell " +
              file("c.vtu") + reports);
  EXPECT_EQ(good.exit_code, 0) << good.err;
  Json report = Json::parse(test::read_file(file("r.json")));
  EXPECT_EQ(report["status"], "ok");
  EXPECT_EQ(report["gates"].size(), 2U);
  EXPECT_EQ(report["gates"][0]["passed"], true);
  EXPECT_EQ(report["statistics"]["symmetry"]["fold"], 7);
  EXPECT_NE(test::read_file(file("j.xml")).find("tests=\"3\" failures=\"0\" errors=\"0\""),
            std::string::npos);

  const Outcome bad = symcell("mesh " + ring_ + " --fail-on 'cell.elements>3' --cell " +
                              file("d.vtu") + " --stats " + file("s.json") + reports);
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_NE(bad.err.find("code gate_failed"), std::string::npos) << bad.err;
  EXPECT_FALSE(std::filesystem::exists(file("d.vtu")));
  EXPECT_TRUE(Json::parse(test::read_file(file("s.json"))).contains("cell"));
  report = Json::parse(test::read_file(file("r.json")));
  EXPECT_EQ(report["status"], "failed");
  EXPECT_EQ(report["error"]["code"], "gate_failed");
  EXPECT_NE(test::read_file(file("j.xml")).find("<failure type=\"gate_failed\""),
            std::string::npos);

  const Outcome none = symcell("mesh " + ring_ + " --max-elements 3" + reports);
  EXPECT_EQ(none.exit_code, 4);
  report = Json::parse(test::read_file(file("r.json")));
  EXPECT_EQ(report["status"], "error");
  EXPECT_TRUE(report["statistics"].is_null());
  EXPECT_NE(test::read_file(file("j.xml")).find("<error type=\"element_limit\""),
            std::string::npos);
  EXPECT_EQ(symcell("mesh " + ring_ + " --fail-on cell").exit_code, 2);
}

TEST_F(Cli, BatchMeshesAFolder) {
  std::filesystem::create_directories(folder_.path() / "in/deep");
  const std::filesystem::path in = folder_.path() / "in";
  std::filesystem::copy_file(ring_, in / "ring.json");
  std::filesystem::copy_file(model("p3_01_hexnut_n6.poly"), in / "deep/nut.poly");
  std::filesystem::copy_file(model("b21_empty.json"), in / "empty.json");
  test::write_file((in / "notes.txt").string(), "no model");
  const std::string flags = " --out " + file("out") + " --format msh --workers 2";
  const Outcome some = symcell("batch " + in.string() + flags + " --summary " + file("all.json") +
                               " --junit " + file("j.xml"));
  EXPECT_EQ(some.exit_code, 1) << some.err;
  EXPECT_NE(some.out.find("2 models, 1 without"), std::string::npos) << some.out;
  const Json all = Json::parse(test::read_file(file("all.json")));
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0]["model"], "empty.json");
  EXPECT_EQ(all[0]["status"], "error");
  EXPECT_EQ(all[0]["error"]["code"], "empty_file");
  EXPECT_EQ(all[1]["statistics"]["symmetry"]["fold"], 7);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out/ring.json.msh"));
  EXPECT_NE(test::read_file(file("j.xml")).find("errors=\"1\""), std::string::npos);

  std::filesystem::remove(in / "empty.json");
  const Outcome good =
      symcell("batch " + in.string() + flags + " --recursive --full --min-dihedral 5");
  EXPECT_EQ(good.exit_code, 1) << good.out;  // a planar model has no dihedral angles
  const Outcome both = symcell("batch " + in.string() + flags + " --recursive --full --order 2");
  EXPECT_EQ(both.exit_code, 0) << both.out;
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "out/deep_nut.poly.full.msh"));
  EXPECT_EQ(symcell("batch /nowhere --out " + file("out")).exit_code, 3);
  EXPECT_EQ(symcell("batch " + in.string() + " --out " + file("out") + " --fold 0").exit_code, 2);
}

TEST_F(Cli, ConvertWritesWhatMeshWouldHave) {
  const std::string nut = model("p3_01_hexnut_n6.poly");
  ASSERT_EQ(
      symcell("mesh " + nut + " --order 2 --cell " + file("c.json") + " --full " + file("f.json"))
          .exit_code,
      0);
  ASSERT_EQ(
      symcell("mesh " + nut + " --order 2 --cell " + file("c.inp") + " --full " + file("f.vtu"))
          .exit_code,
      0);
  const Outcome converted = symcell("convert " + file("c.json") + " --cell " + file("d.inp") +
                                    " --full " + file("g.vtu"));
  ASSERT_EQ(converted.exit_code, 0) << converted.err;
  // Places differ by a rounding.
  const auto lines = [&](const char* name) {
    const std::string text = test::read_file(file(name));
    return std::ranges::count(text, '\n');
  };
  EXPECT_EQ(lines("d.inp"), lines("c.inp"));
  const auto wanted = read_vtu(test::read_file(file("f.vtu")));
  const auto found = read_vtu(test::read_file(file("g.vtu")));
  ASSERT_TRUE(wanted && found);
  EXPECT_EQ(found->points.size(), wanted->points.size());
  EXPECT_EQ(found->element_count(), wanted->element_count());
  EXPECT_EQ(symcell("verify " + file("c.vtu")).exit_code, 3);
  ASSERT_EQ(symcell("convert " + file("c.json") + " --cell " + file("c.vtu")).exit_code, 0);
  const Outcome verify =
      symcell("verify " + file("c.vtu") + " --full " + file("g.vtu") + " --model " + nut);
  EXPECT_EQ(verify.exit_code, 0) << verify.out;
  EXPECT_EQ(symcell("convert " + file("f.json") + " --cell " + file("e.vtu")).exit_code, 3);
  EXPECT_EQ(symcell("convert " + file("c.json")).exit_code, 2);
  EXPECT_EQ(symcell("convert " + nut + " --cell " + file("e.vtu")).exit_code, 3);
}

TEST_F(Cli, ListsMayBeGivenInParts) {
  const std::string nut = model("p3_01_hexnut_n6.poly");
  const auto sizes = [&](const std::string& flags) {
    const Outcome made =
        symcell("mesh " + nut + flags + " --cell " + file("c.vtu") + " --stats " + file("s.json"));
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return Json::parse(test::read_file(file("s.json")))["settings"]["sizes"];
  };
  const Json at_once = sizes(" --sizes vertex:0=0.3,point:0/0/0=0.4");
  EXPECT_EQ(sizes(" --size vertex:0=0.3 --size point:0/0/0=0.4"), at_once);
  EXPECT_EQ(at_once, "vertex:0=0.3,point:0.0/0.0/0.0=0.4");
  EXPECT_EQ(symcell("mesh " + nut + " --fold 6 --fold 3").exit_code, 2);
}

TEST_F(Cli, CompletionKnowsCommandsAndFlags) {
  for (const char* shell : {"bash", "zsh", "fish", "man"}) {
    const Outcome script = symcell(std::string("completion ") + shell);
    EXPECT_EQ(script.exit_code, 0) << script.err;
    for (const char* word : {"mesh", "batch", "transfer", "symmetry"}) {
      EXPECT_NE(script.out.find(word), std::string::npos) << shell << ": " << word;
    }
  }
  const Outcome parsed = symcell("completion bash", "bash -n < /dev/null && ");
  EXPECT_EQ(parsed.exit_code, 0);
  EXPECT_EQ(symcell("completion tcsh").exit_code, 2);
}

TEST_F(Cli, CompletionOffersTheValuesThatThereAre) {
  const std::string script = symcell("completion bash").out;
  EXPECT_NE(script.find("completion:completion) words=\"bash zsh fish man\""), std::string::npos);
  EXPECT_NE(script.find("verify:--repair) words=\"none safe all\""), std::string::npos);
  EXPECT_EQ(script.find('{' + std::string("none")), std::string::npos) << "words of the parser";
  EXPECT_NE(symcell("completion fish").out.find("-a 'bash zsh fish man'"), std::string::npos);
  test::write_file(file("script"), script);
  test::write_file(file("try"), "source " + file("script") +
                                    "\nCOMP_WORDS=(symcell completion '')\nCOMP_CWORD=2\n_symcell\n"
                                    "echo \"${COMPREPLY[@]}\"\n");
  const std::string out = file("offered");
  ASSERT_EQ(std::system(("bash " + file("try") + " > " + out).c_str()), 0);
  EXPECT_EQ(test::read_file(out), "bash zsh fish man\n");
}

TEST_F(Cli, VerifySaysHowToCheckACellThatIsNoVtu) {
  ASSERT_EQ(symcell("mesh " + ring_ + " --cell " + file("c.json")).exit_code, 0);
  const Outcome told = symcell("verify " + file("c.json"));
  EXPECT_EQ(told.exit_code, 3);
  EXPECT_NE(told.err.find("symcell convert " + file("c.json")), std::string::npos) << told.err;
}

TEST_F(Cli, ConvertAndTransferKeepAMemoryLimit) {
  ASSERT_EQ(symcell("mesh " + ring_ + " --cell " + file("c.json")).exit_code, 0);
  const std::string convert = "convert " + file("c.json") + " --full " + file("f.vtu");
  EXPECT_EQ(symcell(convert + " --memory-limit 1").exit_code, 2) << "the program itself needs more";
  EXPECT_EQ(symcell(convert + " --memory-limit 2000").exit_code, 0);
  // A list that takes more than there is.
  std::string large = "{\"type\":\"cell\",\"nodes\":[";
  for (int i = 0; i < 3'000'000; ++i) large += "[0.123456789012345,0.123456789012345,0],";
  test::write_file(file("large.json"), large + "[0,0,0]]}");
  std::filesystem::remove(file("f.vtu"));
  const Outcome limited =
      symcell("convert " + file("large.json") + " --full " + file("f.vtu") + " --memory-limit 200");
  EXPECT_EQ(limited.exit_code, 4) << limited.err;
  EXPECT_NE(limited.err.find("memory_limit"), std::string::npos) << limited.err;
  EXPECT_FALSE(std::filesystem::exists(file("f.vtu")));
  EXPECT_EQ(symcell("transfer " + file("large.json") + " --cell " + file("large.json") +
                    " --full " + file("f.vtu") + " --memory-limit 200")
                .exit_code,
            4);
}

TEST_F(Cli, ABatchTakesNothingForAModelThatABatchHasLeft) {
  const std::filesystem::path in = folder_.path() / "in";
  std::filesystem::create_directories(in);
  std::filesystem::copy_file(ring_, in / "ring.json");
  const std::string batch =
      "batch " + in.string() + " --recursive --format json --out " + (in / "out").string();
  for (int times = 0; times < 2; ++times) {
    const Outcome done = symcell(batch);
    EXPECT_EQ(done.exit_code, 0) << done.out << done.err;
    EXPECT_NE(done.out.find("1 models"), std::string::npos) << done.out;
  }
  const Outcome same = symcell("batch " + in.string() + " --out " + in.string());
  EXPECT_EQ(same.exit_code, 2);
  EXPECT_NE(same.err.find("--out"), std::string::npos) << same.err;
}

TEST_F(Cli, NoOutputTakesThePlaceOfAModelOrOfAnotherOutput) {
  namespace fs = std::filesystem;
  const std::string model = file("in.json");
  fs::copy_file(ring_, model);
  const std::string bytes = test::read_file(model);
  fs::create_hard_link(model, file("hard.json"));
  fs::create_symlink(model, file("soft.json"));
  fs::create_symlink(folder_.path(), file("here"));
  const std::string mesh = "mesh " + model + " --quiet ";
  const auto refused = [&](const std::string& arguments, const std::string& word) {
    const Outcome outcome = symcell(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << arguments << outcome.err;
    EXPECT_EQ(test::read_file(model), bytes) << arguments;
  };
  for (const char* name : {"in.json", "hard.json", "soft.json", "here/in.json", "./in.json"}) {
    for (const char* flag : {"--cell ", "--full ", "--stats ", "--report ", "--junit "}) {
      refused(mesh + flag + file(name), "the model");
    }
  }
  refused("mesh - --cell " + model + " < " + model, "the model");
  // Files that do not exist yet, by other ways to the same name.
  for (const char* name : {"s.json", "here/s.json", "./s.json", "no/../s.json"}) {
    refused(mesh + "--cell " + file("s.json") + " --full " + file(name), "same file");
    refused(mesh + "--cell " + file("s.json") + " --stats " + file(name), "same file");
    refused(mesh + "--report " + file("s.json") + " --junit " + file(name), "same file");
    EXPECT_FALSE(fs::exists(file("s.json"))) << name;
  }
  const std::string cell = file("c.json");
  ASSERT_EQ(symcell(mesh + "--cell " + cell).exit_code, 0);
  refused("convert " + cell + " --full " + cell, "same file");
  refused("convert " + cell + " --cell x.vtu --full ./x.vtu", "same file");
  refused("convert " + cell + " --cell - --full -", "standard output");
  refused("transfer r.frd --cell " + cell + " --full " + cell, "same file");
  refused("transfer " + cell + " --cell c.vtu --full " + cell, "same file");
  // Nothing is lost in a device.
  EXPECT_EQ(symcell(mesh + "--format vtu --cell /dev/null --full /dev/null").exit_code, 0);
}

TEST_F(Cli, WordsOfErrorsLeadOn) {
  const auto says = [&](const std::string& arguments, const std::string& words) {
    const Outcome outcome = symcell(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  };
  says("mesh " + ring_ + " --min-angel 3", "did you mean --min-angle?");
  says("mesh " + ring_ + " --min-angel=3", "did you mean --min-angle?");
  says("mesh " + ring_ + " --center 1e300,0", "1e60");
  says("mesh " + ring_ + " --time-limit 1e308", "1e9");
  ASSERT_EQ(symcell("mesh " + ring_ + " --cell " + file("c.vtu")).exit_code, 0);
  const std::string cell = file("c.vtu");
  says("transfer " + cell + " --cell " + cell + " --full " + file("f.vtu"), "--array");
}

TEST_F(Cli, ACellMayBeginWithAByteOrderMark) {
  ASSERT_EQ(symcell("mesh " + ring_ + " --cell " + file("c.json")).exit_code, 0);
  const std::string marked = "printf '\\357\\273\\277' | cat - " + file("c.json") + " | ";
  const Outcome converted = symcell("convert - --full " + file("f.vtu"), marked);
  EXPECT_EQ(converted.exit_code, 0) << converted.err;
}

TEST_F(Cli, ABatchWritesOverNoModel) {
  namespace fs = std::filesystem;
  const std::string parts = file("parts");
  const std::string out = file("out");
  fs::create_directory(parts);
  fs::create_directory(out);
  fs::copy_file(ring_, parts + "/a.json");
  const std::string bytes = test::read_file(ring_);
  const std::string batch = "batch " + parts + " --out " + out + " --format json ";
  EXPECT_EQ(symcell(batch + "--summary " + parts + "/a.json").exit_code, 2);
  EXPECT_EQ(symcell(batch + "--junit " + parts + "/a.json").exit_code, 2);
  EXPECT_EQ(symcell(batch + "--junit j --summary j").exit_code, 2);
  EXPECT_EQ(symcell(batch + "--summary " + out + "/a.json.report.json").exit_code, 2);
  EXPECT_EQ(test::read_file(parts + "/a.json"), bytes);
  // A model that lies where the mesh of another will be.
  fs::copy_file(ring_, out + "/a.json.json");
  fs::create_symlink(out + "/a.json.json", parts + "/b.json");
  const Outcome linked = symcell(batch);
  EXPECT_EQ(linked.exit_code, 2);
  EXPECT_NE(linked.err.find("the model"), std::string::npos) << linked.err;
  EXPECT_EQ(test::read_file(out + "/a.json.json"), bytes);
}

// The signal comes to the batch alone, which passes it on.
TEST_F(Cli, ABatchEndsWithASignal) {
  const std::filesystem::path in = folder_.path() / "in";
  std::filesystem::create_directories(in);
  for (const char* name : {"a.json", "b.json", "c.json"}) {
    std::filesystem::copy_file(ring_, in / name);
  }
  const Outcome stopped =
      symcell("batch " + in.string() + " --workers 1 --max-area 1e-6 --out " + file("out"),
              "timeout --foreground -s TERM -k 60 2 ");
  EXPECT_EQ(stopped.exit_code, 124);
  EXPECT_NE(stopped.out.find("3 models, 3 without"), std::string::npos) << stopped.out;
  EXPECT_NE(stopped.err.find("stopped by a signal"), std::string::npos) << stopped.err;
}

}  // namespace
}  // namespace symcell
