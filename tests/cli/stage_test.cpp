// The frame of the stage programs: options, exit codes, and what reaches which stream.

#include "cli/stage.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "helpers/test_paths.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::cli {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

struct Outcome {
    int code = -1;
    std::string out;
    std::string err;
};

/// Points a stream of this process at a file.
void redirect(int stream, const std::filesystem::path& path) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (file < 0 || ::dup2(file, stream) < 0) std::_Exit(99);
}

/// Variables of the stage's options, in the process that runs it.
int count = 3;
std::optional<std::string> name;

StageDefinition definition() {
    StageDefinition stage;
    stage.next = [](const StageCall&) { return "flightwatt show {in} {}"; };
    stage.name = "trial";
    stage.arguments = "FILE...";
    stage.description = "Tries things.";
    stage.max_inputs = 2;
    stage.examples = {"flightwatt trial a"};
    stage.reads_logs = true;
    stage.options.add("count", count, {.value = "N"}, "how many");
    stage.options.add("name", name, {.value = "NAME"}, "whose");
    return stage;
}

/// Runs the stage in a process of its own: run_stage closes the standard output.
Outcome run(std::vector<std::string> arguments, const StageBody& body, const std::filesystem::path& out = {},
            const std::filesystem::path& in = {}) {
    const auto folder = test::scratch_dir();
    const auto out_file = out.empty() ? folder / "stdout" : out;
    std::fflush(nullptr);  // or the child would print the rest of this process again
    const auto child = ::fork();
    if (child == 0) {
        if (!in.empty() && ::dup2(::open(in.c_str(), O_RDONLY), STDIN_FILENO) < 0) std::_Exit(99);
        redirect(STDOUT_FILENO, out_file);
        redirect(STDERR_FILENO, folder / "stderr");
        arguments.insert(arguments.begin(), "flightwatt-trial");
        std::vector<char*> argv;
        for (auto& argument : arguments) argv.push_back(argument.data());
        std::_Exit(run_stage(static_cast<int>(argv.size()), argv.data(), definition(), body));
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, out.empty() ? read_file(out_file) : "",
            read_file(folder / "stderr")};
}

int succeed(const StageCall&) { return ok; }

/// A body that throws.
template <typename Error>
StageBody failing_with(Error error) {
    return [error](const StageCall&) -> int { throw error; };
}

TEST(RunStage, HandsOverWhatTheUserGave) {
    const auto result = run({"a", "--count", "7", "-o", "result.csv", "--json", "b"}, [](const StageCall& call) {
        print(call.program + " " + call.inputs.at(0) + call.inputs.at(1) + " " + std::to_string(count) + " " +
              call.output.value() + (call.json ? " json" : "") + (call.has("name") ? " named" : " nameless"));
        return ok;
    });
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.out, "flightwatt-trial ab 7 result.csv json nameless");
    EXPECT_EQ(result.err, "");
}

TEST(RunStage, HasDefaults) {
    const auto result = run({"a"}, [](const StageCall& call) {
        return count == 3 && !name && !call.json && !call.output ? ok : no_answer;
    });
    EXPECT_EQ(result.code, 0);
}

TEST(RunStage, TakesFileNamesThatLookLikeOptionsAfterTwoDashes) {
    const auto result = run({"--", "--count"}, [](const StageCall& call) {
        print(call.inputs.at(0));
        return ok;
    });
    EXPECT_EQ(result.out, "--count");
}

TEST(RunStage, HelpsWithoutRunningTheBody) {
    for (const auto* option : {"--help", "-h"}) {
        const auto result = run({option}, failing_with(std::runtime_error("ran")));
        EXPECT_EQ(result.code, 0);
        EXPECT_THAT(result.out, StartsWith("usage: flightwatt trial FILE... [options]\n\nTries things.\n\nOptions:\n"));
        EXPECT_THAT(result.out, HasSubstr("--count N (=3)"));
        EXPECT_EQ(result.err, "");
    }
    EXPECT_EQ(run({"--version"}, failing_with(std::runtime_error("ran"))).out,
              "flightwatt-trial " FLIGHTWATT_VERSION "\n");
}

TEST(RunStage, RefusesWrongUsage) {
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
        {{}, "no input given; usage: flightwatt trial FILE... [options]"},
        {{"a", "b", "c"}, "unexpected argument 'c'; usage: flightwatt trial FILE... [options]"},
        {{"a", "--counts", "1"}, "unrecognised option '--counts'; did you mean '--count'?"},
        {{"a", "--coun", "1"}, "unrecognised option '--coun'; did you mean '--count'?"},  // no guessing
        {{"a", "--elephant"}, "unrecognised option '--elephant'; see --help"},
        {{"a", "--count", "x"}, "--count x: expected a whole number"},
        {{"a", "--count=1", "--count=2"}, "option '--count' cannot be specified more than once; see --help"},
        {{"a", "--name"}, "the required argument for option '--name' is missing; see --help"},
    };
    for (const auto& [arguments, message] : cases) {
        const auto result = run(arguments, succeed);
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(result.err, "flightwatt-trial: error: " + message + "\n");
    }
}

TEST(RunStage, TurnsExceptionsIntoALineAndAnExitCode) {
    const auto result = run({"a"}, failing_with(InputError({"f.csv", 12, 7}, "is wrong", "repair it")));
    EXPECT_EQ(result.code, 3);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "flightwatt-trial: f.csv:12:7: error: is wrong; repair it\n");
    const auto nowhere = run({"a"}, failing_with(InputError({}, "is wrong")));
    EXPECT_EQ(nowhere.err, "flightwatt-trial: error: is wrong\n");
    EXPECT_EQ(run({"a"}, failing_with(UsageError("x"))).code, 2);
    EXPECT_EQ(run({"a"}, failing_with(NoResultError("x"))).code, 4);
    EXPECT_EQ(run({"a"}, failing_with(OutputError("x"))).code, 1);
    EXPECT_EQ(run({"a"}, failing_with(OutputError("x"))).err, "flightwatt-trial: error: x\n");
    const auto no_memory = run({"a"}, failing_with(std::bad_alloc()));
    EXPECT_EQ(no_memory.code, 1);
    EXPECT_EQ(no_memory.err, "flightwatt-trial: error: there is not enough memory\n");
    const std::filesystem::filesystem_error of_file("status", "a/b",
                                                    std::make_error_code(std::errc::permission_denied));
    EXPECT_EQ(run({"a"}, failing_with(of_file)).err,
              "flightwatt-trial: a/b: error: cannot be used: Permission denied\n");
    EXPECT_EQ(run({"a"}, failing_with(of_file)).code, 3);
    const auto unknown = run({"a"}, failing_with(std::runtime_error("x")));
    EXPECT_EQ(unknown.code, 1);
    EXPECT_EQ(unknown.err, "flightwatt-trial: error: internal error: x\n");
}

TEST(RunStage, PassesTheBodysExitCodeOn) {
    EXPECT_EQ(run({"a"}, [](const StageCall&) { return int(input_rejected); }).code, 3);
}

TEST(RunStage, KeepsDiagnosticsOnOneLine) {
    const auto error = run({"a"}, failing_with(InputError({"a\nb", 1}, "holds '\x1b[2J\r\n'")));
    EXPECT_EQ(error.err, R"(flightwatt-trial: a b:1: error: holds '\x1b[2J\x0d ')"
                         "\n");
    const auto notes = run({"a"}, [](const StageCall& call) {
        warn(call, "one\ntwo");
        note(call, "three\tfour");
        return ok;
    });
    EXPECT_EQ(notes.err, "flightwatt-trial: three four\nflightwatt-trial: warning: one two\n");
    EXPECT_EQ(one_line("\xC3\xBC \xFF"), "\xC3\xBC \xFF");  // what is no control character stays
}

TEST(TypedInShell, QuotesWhatAShellWouldTakeApart) {
    EXPECT_EQ(shell_quoted("fits/model-1.toml"), "fits/model-1.toml");
    EXPECT_EQ(shell_quoted("a b$c"), "'a b$c'");
    EXPECT_EQ(shell_quoted("it's"), R"('it'\''s')");
    EXPECT_EQ(shell_quoted(""), "''");
}

TEST(RunStage, FailsWhereTheStandardOutputCannotBeWritten) {
    const auto small = run(
        {"a"},
        [](const StageCall&) {
            print("x");
            return int(ok);
        },
        "/dev/full");
    EXPECT_EQ(small.code, 1);  // found when the buffer is flushed, after the body
    EXPECT_EQ(small.err, "flightwatt-trial: error: cannot write the standard output: No space left on device\n");
    const auto large = run(
        {"a"},
        [](const StageCall&) {
            print(std::string(1 << 20, 'x'));
            return int(ok);
        },
        "/dev/full");
    EXPECT_EQ(large.code, 1);
    EXPECT_EQ(run({"--help"}, succeed, "/dev/full").code, 1);
}

TEST(RunStage, DoesNotSayOkWhenTheBodyFailsAndTheOutputIsFull) {
    const auto result = run(
        {"a"},
        [](const StageCall&) -> int {
            print("x");
            throw InputError({}, "is wrong");
        },
        "/dev/full");
    EXPECT_EQ(result.code, 3);
}

TEST(WriteResult, GoesToTheFileOrTheStandardOutput) {
    const auto body = [](const StageCall& call) {
        write_result(call, "result\n");
        return int(ok);
    };
    EXPECT_EQ(run({"a"}, body).out, "result\n");
    EXPECT_EQ(run({"a", "--json"}, body).out, "");  // JSON has the standard output to itself
    const auto file = test::scratch_dir().parent_path() / "WriteResult.csv";
    std::filesystem::remove(file);
    EXPECT_EQ(run({"a", "-o", file.string()}, body).out, "");
    EXPECT_EQ(read_file(file), "result\n");
    EXPECT_EQ(
        run({"a b", "-o", file.string()}, body).err,
        "flightwatt-trial: " + file.string() + " is written; next: flightwatt show 'a b' " + file.string() + "\n");
    EXPECT_EQ(run({"a", "-o", file.string(), "--json"}, body).err, "");
    EXPECT_EQ(run({"a", "-o", file.string(), "--quiet"}, body).err, "");
    std::filesystem::remove(file);
    const auto missing = run({"a", "-o", "/missing/folder/x"}, body);
    EXPECT_EQ(missing.code, 1);
    EXPECT_EQ(missing.err,
              "flightwatt-trial: error: cannot write /missing/folder/x: No such file or directory; "
              "make its folder first: mkdir -p /missing/folder\n");
}

TEST(RunStage, ReadsALogFromTheStandardInput) {
    const auto input = test::scratch_dir().parent_path() / "StandardInput.data";
    std::ofstream(input) << "a log\n";
    const auto result = run(
        {"-"},
        [&](const StageCall& call) {
            print(read_file(call.inputs.at(0)));
            return ok;
        },
        {}, input);
    EXPECT_EQ(result.out, "a log\n");
}

TEST(RunStage, RefusesAStandardInputThatCannotBeCopied) {
    const auto input = test::scratch_dir().parent_path() / "StandardInput.data";
    std::ofstream(input) << "a log\n";
    ASSERT_EQ(::setenv("TMPDIR", "/missing", 1), 0);
    const auto result = run({"-"}, succeed, {}, input);
    ::unsetenv("TMPDIR");
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.err, HasSubstr("/missing"));
}

TEST(RunStage, IsQuietOnRequest) {
    const auto body = [](const StageCall& call) {
        note(call, "a note");
        warn(call, "a warning");
        return ok;
    };
    EXPECT_THAT(run({"a"}, body).err, HasSubstr("a note"));
    const auto quiet = run({"a", "--quiet"}, body).err;
    EXPECT_THAT(quiet, Not(HasSubstr("a note")));
    EXPECT_THAT(quiet, HasSubstr("a warning"));
}

TEST(RunStage, DescribesItselfAsJson) {
    const auto json = Json::parse(run({"--json-usage"}, succeed).out);
    EXPECT_EQ(json["stage"], "trial");
    EXPECT_EQ(json["max_inputs"], 2);
    EXPECT_EQ(json["examples"], Json::array({"flightwatt trial a"}));
    EXPECT_EQ(json["options"][0]["name"], "count");
}

TEST(JsonText, EndsWithALineBreakAndReplacesWhatIsNotUtf8) {
    EXPECT_EQ(json_text({{"flight", "caf\xE9"}}), "{\n  \"flight\": \"caf\xEF\xBF\xBD\"\n}\n");
}

}  // namespace
}  // namespace flightwatt::cli
