#pragma once

#include "base/diagnostic.h"
#include "base/error.h"
#include "base/text.h"
#include "cli/options.h"
#include "record/record.h"

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace flightwatt::cli {

using flightwatt::Json;

enum ExitCode : int {
    ok = 0,
    internal_error = 1,
    usage_error = 2,
    input_rejected = 3,
    no_answer = 4,
    requirement_missed = 5
};

struct StageCall;

/// Name and interface of a stage, beyond the options that every stage has (--help, --version, --json, --output, --quiet,
/// --notes).
struct StageDefinition {
    std::string name;                        ///< "fit"; the program is flightwatt-fit
    std::string arguments;                   ///< shown in the usage line: "FLIGHT..."
    std::string description;                 ///< for --help
    std::vector<std::string> examples = {};  ///< commands, for --help and the man page
    Options options = {};
    std::size_t min_inputs = 1;
    std::size_t max_inputs = 1000000;
    Json (*json_schema)() = nullptr;  ///< of --json, which --json-schema prints
    bool reads_logs = false;          ///< its inputs are logs: - is the standard input
    bool uses_threads = false;        ///< then --jobs is an option
    bool shows_table = false;         ///< on a terminal: then --wide is an option
    bool is_live = false;             ///< runs for hours: warnings are shown at once, and not after the result
    /// What can follow on a result in --output ({}), with the input ({in}): "flightwatt simulate {}"; or empty.
    std::function<std::string(const StageCall&)> next = nullptr;
    std::string output_value = "FILE";
    std::string output_help = "write the result to FILE instead of the standard output";
};

/// An input of several that cannot be used.
struct SkippedInput {
    std::string file;
    std::string reason;
};

/// A call of a stage. The options of the stage itself are in the variables to which they are bound.
struct StageCall {
    std::string program;          ///< "flightwatt-fit", for diagnostics
    std::string command;          ///< as a user types it: "flightwatt fit my -o model.toml"
    std::set<std::string> given;  ///< names of the options that the user gave
    std::vector<std::string> inputs;
    bool json = false;
    bool wide = false;
    bool notes = false;    ///< each diagnostic is shown, also what an earlier stage has shown
    bool is_live = false;  ///< see StageDefinition
    std::optional<std::string> output;
    /// See skip_input; shared by copies of the call.
    std::shared_ptr<std::vector<SkippedInput>> skipped = std::make_shared<std::vector<SkippedInput>>();
    /// Shown after the result; shared by copies of the call.
    std::shared_ptr<Diagnostics> diagnostics = std::make_shared<Diagnostics>();

    bool has(const std::string& option) const { return given.contains(option); }
};

using StageBody = std::function<int(const StageCall&)>;

/// Sets the variables of the stage's options, and runs the body, guarded as below; or shows --help, --version or
/// --json-usage.
int run_stage(int argc, char** argv, StageDefinition definition, const StageBody& body);

/// An input that cannot be used, an error of the kind "skipped"; the others are used. The exit code of the stage is then
/// input_rejected instead of ok.
void skip_input(const StageCall& call, const std::string& file, const InputError& error);

/// The exit code of the body. An exception becomes one line on the standard error and its exit code; a standard
/// output that was not written (full disk, closed) is an error as well. Where its reader has left (head), the body runs
/// to its end and the program ends as SIGPIPE ends programs. A standard error that cannot be written changes nothing.
/// Closes the standard output.
int run_guarded(const std::string& program, const std::function<int()>& body);

/// The version, and the commit in parentheses where it is known: "0.2.0 (c72d378)". For --version alone: files and JSON
/// have the version, because equal inputs give equal bytes at every commit.
std::string version_text();

/// The result to --output's file (atomically), or to the standard output unless --json claims that.
void write_result(const StageCall& call, std::string_view content);

/// To the standard output. Throws OutputError (full disk, closed); of a pipe without a reader see
/// run_guarded.
void print(std::string_view text);

/// As print(), written at once, for programs that continue; false if the pipe has no reader any more.
bool print_flushed(std::string_view text);

/// A file's name as a user types it in a shell: quoted where it has to be.
std::string shell_quoted(std::string_view file);

/// Indented, with a line break at its end. A name that is not UTF-8 (a file's) does not spoil the answer.
inline std::string json_text(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Raised with every change of a key that readers have to know.
inline constexpr int json_format = 1;

/// The JSON of a stage: an object that begins with "format" and "stage", then the fields of a record.
Json json_document(const StageCall& call, const Json& record);

/// Prints a record as the JSON of the stage.
template <Record R>
void print_json(const StageCall& call, const R& record) {
    print(json_text(json_document(call, record_json(record))));
}

Json json_schema(std::vector<Json> forms);

/// For StageDefinition::json_schema: the schema of documents that are one of these records.
template <Record... Forms>
Json document_schema() {
    return json_schema({record_schema<Forms>()...});
}

/// Collects a diagnostic, which is shown after the result.
void add_diagnostic(const StageCall& call, Diagnostic diagnostic);

/// Collects a warning that belongs to no flight and no kind.
void warn(const StageCall& call, std::string_view message);

/// A line about the result on the standard error, at once: "flightwatt-fit: ...", without the program on a terminal.
void note(const StageCall& call, std::string_view message);

/// Lines on the standard error, as they are: a table, or commands to paste. What cannot be written (closed, full disk) is
/// dropped.
void print_lines(std::string_view lines);

}  // namespace flightwatt::cli
