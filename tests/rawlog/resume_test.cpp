#include <gmock/gmock.h>
#include <submap_slam/core/errors.h>

#include "../support/temp_folder.h"
#include "sample_submaps.h"

namespace submap_slam {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/** Stretches of 1, 2, 0 and 1 submaps. */
std::vector<GridSubmaps> sampleStretches() {
  return {sampleSubmaps(0, 1), sampleSubmaps(1, 2), {}, sampleSubmaps(3, 1)};
}

void writeFrom(SubmapLogWriter& writer) {
  const auto stretches = sampleStretches();
  for (auto k = writer.state().stretches_done; k < stretches.size(); ++k) writer.appendStretch(stretches[k]);
  writer.finish();
}

std::string wholeRun(const TempFolder& temp) {
  const auto file = temp.file("whole.rawlog");
  SubmapLogWriter writer(file, sampleRun());
  writeFrom(writer);
  return file;
}

TEST(Resume, StateRoundTrip) {
  TempFolder temp;
  const auto file = temp.file("s.rawlog");
  EXPECT_FALSE(readResumeState(file));
  auto state = sampleRun();
  state.stretches_done = 7;
  state.submaps_done = 9;
  state.submap_bytes = 5'000'000'000;
  state.complete = true;
  writeResumeState(file, state);
  const auto read = readResumeState(file);
  ASSERT_TRUE(read);
  EXPECT_EQ(runDifference(*read, state), "");
  EXPECT_EQ(read->stretches_done, 7u);
  EXPECT_EQ(read->submaps_done, 9u);
  EXPECT_EQ(read->submap_bytes, 5'000'000'000u);
  EXPECT_TRUE(read->complete);
  EXPECT_FALSE(std::filesystem::exists(resumeFileOf(file) + ".new"));
}

TEST(Resume, DamagedStateIsAnInputError) {
  TempFolder temp;
  for (const std::string text : {"", "{", "[1]", "{\"version\": 3}"}) {
    temp.write("s.rawlog.resume.json", text);
    EXPECT_THROW(readResumeState(temp.file("s.rawlog")), InputError) << text;
  }
}

TEST(Resume, InterruptedRunEndsInTheSameBytes) {
  TempFolder temp;
  const auto whole = wholeRun(temp);
  const auto stretches = sampleStretches();
  for (std::size_t done = 0; done <= stretches.size(); ++done) {
    const auto file = temp.file("resumed" + std::to_string(done) + ".rawlog");
    {
      SubmapLogWriter writer(file, sampleRun());
      for (std::size_t k = 0; k < done; ++k) writer.appendStretch(stretches[k]);
    }
    auto resumed = SubmapLogWriter::resume(file, sampleRun());
    EXPECT_EQ(resumed.state().stretches_done, done);
    writeFrom(resumed);
    EXPECT_EQ(readAll(file), readAll(whole));
    EXPECT_EQ(readAll(resumeFileOf(file)), readAll(resumeFileOf(whole)));
  }
}

TEST(Resume, DropsWhatWasWrittenAfterTheLastCompleteStretch) {
  TempFolder temp;
  const auto whole = wholeRun(temp);
  const auto stretches = sampleStretches();
  const auto next = gzipMember(*stretches[1][0]);
  const std::string member(next.begin(), next.end());
  // killed in the middle of a submap, after the first of two submaps of a stretch, in the middle of the
  // second
  for (const auto& rest :
       {member.substr(0, 5), member.substr(0, member.size() / 2), member, member + member.substr(0, 30)}) {
    const auto file = temp.file("resumed.rawlog");
    SubmapLogWriter(file, sampleRun()).appendStretch(stretches[0]);
    temp.write("resumed.rawlog", readAll(file) + rest);
    auto resumed = SubmapLogWriter::resume(file, sampleRun());
    EXPECT_EQ(resumed.state().submaps_done, 1u);
    writeFrom(resumed);
    EXPECT_EQ(readAll(file), readAll(whole));
  }
}

TEST(Resume, StartsAnewWithoutSideCar) {
  TempFolder temp;
  const auto file = temp.write("s.rawlog", "left over");
  auto writer = SubmapLogWriter::resume(file, sampleRun());
  EXPECT_EQ(writer.state().stretches_done, 0u);
  writeFrom(writer);
  EXPECT_EQ(readSubmaps(file).size(), 4u);
}

TEST(Resume, CompleteFileIsLeftAlone) {
  TempFolder temp;
  const auto whole = wholeRun(temp);
  const auto bytes = readAll(whole);
  auto writer = SubmapLogWriter::resume(whole, sampleRun());
  EXPECT_TRUE(writer.state().complete);
  EXPECT_THROW(writer.appendStretch({}), std::logic_error);
  EXPECT_EQ(readAll(whole), bytes);
}

TEST(Resume, RefusesAnotherRun) {
  TempFolder temp;
  const auto file = temp.file("s.rawlog");
  SubmapLogWriter(file, sampleRun()).appendStretch(sampleSubmaps(0, 1));
  const auto bytes = readAll(file);
  auto other = sampleRun();
  other.config_hash = "xyz";
  try {
    SubmapLogWriter::resume(file, other);
    FAIL() << "another configuration was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(file), HasSubstr("other parameters")));
  }
  EXPECT_EQ(readAll(file), bytes);
}

TEST(Resume, RefusesAFileThatDoesNotHoldWhatTheSideCarSays) {
  TempFolder temp;
  const auto file = temp.file("s.rawlog");
  SubmapLogWriter(file, sampleRun()).appendStretch(sampleSubmaps(0, 2));
  const auto bytes = readAll(file);
  auto flipped = bytes;
  flipped[bytes.size() / 3] = static_cast<char>(flipped[bytes.size() / 3] ^ 4);
  for (const auto& content : {bytes.substr(0, bytes.size() - 1), std::string(), flipped}) {
    temp.write("s.rawlog", content);
    EXPECT_THROW(SubmapLogWriter::resume(file, sampleRun()), InputError);
    EXPECT_EQ(readAll(file), content);
  }
}

TEST(Resume, NamesEveryDifference) {
  const auto run = sampleRun();
  auto version = run, config = run, log = run, size = run, content = run;
  version.version = "2";
  config.config_hash = "2";
  log.log = "2";
  size.log_bytes = 2;
  content.log_hash = "2";
  EXPECT_EQ(runDifference(run, version), "another version");
  EXPECT_EQ(runDifference(run, config), "other parameters");
  EXPECT_EQ(runDifference(run, log), "another log");
  EXPECT_EQ(runDifference(run, size), "a log of another size");
  EXPECT_EQ(runDifference(run, content), "a log of other content");
}

TEST(Resume, IdentityIsWrittenAndReadBack) {
  TempFolder temp;
  const auto file = temp.file("s.rawlog");
  const SubmapLogWriter writer(file, sampleRun());
  const auto state = readResumeState(file);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->log_hash, sampleRun().log_hash);
  EXPECT_EQ(runDifference(*state, sampleRun()), "");
}

TEST(Resume, OnlyOneWriterAtATime) {
  TempFolder temp;
  const auto file = temp.file("s.rawlog");
  const auto refusal = [&](auto open) -> std::string {
    try {
      open();
    } catch (const OutputError& error) {
      return error.what();
    }
    return "no error";
  };
  const auto anew = [&] { SubmapLogWriter{file, sampleRun()}; };
  const auto resumed = [&] { SubmapLogWriter::resume(file, sampleRun()); };
  {
    SubmapLogWriter writer(file, sampleRun());
    writer.appendStretch(sampleSubmaps(0, 1));
    const auto bytes = readAll(file), state = readAll(resumeFileOf(file));
    EXPECT_THAT(refusal(anew), AllOf(HasSubstr(file), HasSubstr("another run")));
    EXPECT_THAT(refusal(resumed), AllOf(HasSubstr(file), HasSubstr("another run")));
    EXPECT_EQ(readAll(file), bytes);
    EXPECT_EQ(readAll(resumeFileOf(file)), state);
    writer.finish();
    EXPECT_THAT(refusal(resumed), HasSubstr("another run")) << "finished, but still in use";
  }
  EXPECT_EQ(refusal(resumed), "no error");
  EXPECT_EQ(refusal(anew), "no error");
}

TEST(Resume, HashOfTheEndsOfAFile) {
  constexpr std::size_t kMegabyte = 1 << 20;
  TempFolder temp;
  const auto hashOf = [&](const std::string& content) { return endsHash(temp.write("a", content)); };
  EXPECT_EQ(hashOf(""), textHash(""));
  EXPECT_EQ(hashOf("foobar"), textHash("foobar"));
  const std::string whole(3 * kMegabyte, 'x');
  EXPECT_EQ(hashOf(whole), textHash(std::string(2 * kMegabyte, 'x')));
  for (const std::size_t at : {std::size_t{0}, kMegabyte - 1, 2 * kMegabyte, 3 * kMegabyte - 1}) {
    auto edited = whole;
    edited[at] = 'y';
    EXPECT_NE(hashOf(edited), hashOf(whole)) << at;
  }
  EXPECT_THROW(endsHash(temp.file("missing")), InputError);
}

TEST(Resume, WritingToAnImpossiblePlaceIsAnOutputError) {
  TempFolder temp;
  const auto file = temp.file("missing_folder/s.rawlog");
  try {
    SubmapLogWriter writer(file, sampleRun());
    FAIL() << "no error";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(file));
  }
}

TEST(Resume, FullDiskIsAnOutputErrorNamingTheFile) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "needs /dev/full";
  TempFolder temp;
  const auto file = temp.file("s.rawlog");
  std::filesystem::create_symlink("/dev/full", file);
  try {
    SubmapLogWriter(file, sampleRun()).appendStretch(sampleSubmaps(0, 1));
    FAIL() << "no error";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(file), HasSubstr("No space left")));
  }
}

// Published test vectors of FNV-1a, 64 bits.
TEST(Resume, TextHash) {
  EXPECT_EQ(textHash(""), "cbf29ce484222325");
  EXPECT_EQ(textHash("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(textHash("foobar"), "85944171f73967e8");
}

}  // namespace
}  // namespace submap_slam
