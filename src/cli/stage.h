#pragma once

#include "base/error.h"
#include "cli/stage.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/program_options.hpp>
#include <nlohmann/json.hpp>

namespace flightwatt::cli {

using Json = nlohmann::ordered_json;

enum ExitCode : int { ok = 0, internal_error = 1, usage_error = 2, input_rejected = 3, no_answer = 4 };

/// An option's value, as --help names it.
template <typename T = std::string>
auto* value(const char* name) {
    return boost::program_options::value<T>()->value_name(name);
}

/// What the file (or folder) that an option names is to the stage.
enum class FileRole { input, output };

/// An option that names a file, or as T several, as --help names it. Files to write are refused before the work where
/// they are files to read, or two of them are one.
struct FileOption {
    FileRole role;
};
template <typename T>
struct FileValue : boost::program_options::typed_value<T>, FileOption {
    FileValue(const char* name, FileRole of) : boost::program_options::typed_value<T>(nullptr), FileOption{of} {
        this->value_name(name);
    }
};

inline auto* input_files(const char* name) { return new FileValue<std::vector<std::string>>(name, FileRole::input); }
inline auto* input_file(const char* name) { return new FileValue<std::string>(name, FileRole::input); }
inline auto* output_file(const char* name) { return new FileValue<std::string>(name, FileRole::output); }

/// What a stage program is called and accepts beyond --help, --version, --json and --output.
struct StageDefinition {
    std::string name;         ///< "fit"; the program is flightwatt-fit
    std::string arguments;    ///< shown in the usage line: "FLIGHT..."
    std::string description;  ///< what it does, for --help
    boost::program_options::options_description options{"Options"};
    std::size_t min_inputs = 1;
    std::size_t max_inputs = 1000000;
    bool shows_table = false;  ///< on a terminal: then --wide is an option
    std::string output_help = "write the result to FILE instead of the standard output";
};

/// An input of several that cannot be used.
struct SkippedInput {
    std::string file;
    std::string reason;
};

/// What the user gave.
struct StageCall {
    std::string program;  ///< "flightwatt-fit", for diagnostics
    boost::program_options::variables_map options;
    std::vector<std::string> inputs;
    bool json = false;
    std::optional<std::string> output;
    /// See skip_input; shared by copies of the call.
    std::shared_ptr<std::vector<SkippedInput>> skipped = std::make_shared<std::vector<SkippedInput>>();

    bool has(const std::string& option) const { return options.count(option) > 0; }
    template <typename T>
    T get(const std::string& option) const {
        return options[option].as<T>();
    }
    /// The option's value, if it was given.
    template <typename T>
    std::optional<T> get_optional(const std::string& option) const {
        return has(option) ? std::optional<T>(get<T>(option)) : std::nullopt;
    }
};

using StageBody = std::function<int(const StageCall&)>;

/// Parses the options of a stage, answers --help and --version, and runs the body, guarded as below.
int run_stage(int argc, char** argv, const StageDefinition& definition, const StageBody& body);

/// Names an input that cannot be used, on the standard error, so that the others go on. The exit code of the stage is
/// then input_rejected instead of ok.
void skip_input(const StageCall& call, const std::string& file, const InputError& error);

/// The exit code of the body. An exception becomes one line on the standard error and its exit code; a standard
/// output that was not written (full disk, closed) is an error as well. Where its reader has left (head), the body runs
/// to its end and the program ends as SIGPIPE ends programs. A standard error that cannot be written changes nothing.
/// Closes the standard output.
int run_guarded(const std::string& program, const std::function<int()>& body);

/// The result to --output's file (atomically), or to the standard output unless --json claims that.
void write_result(const StageCall& call, std::string_view content);

/// To the standard output. Throws OutputError (full disk, closed); of a pipe that nobody reads any more see
/// run_guarded.
void print(std::string_view text);

/// As print(), seen at once, for programs that go on; false if nobody reads any more.
bool print_flushed(std::string_view text);

/// `text` with blanks for control characters: diagnostics stay on one line, whatever a file (or its name) put
/// into them.
std::string one_line(std::string_view text);

/// A file's name as a user types it in a shell: quoted where it has to be.
std::string shell_quoted(std::string_view file);

/// Indented, with a line break at its end. A name that is not UTF-8 (a file's) does not spoil the answer.
inline std::string json_text(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// null for what is not known.
template <typename T>
Json optional_json(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

/// A line on the standard error: "flightwatt-fit: warning: ...".
void warn(const StageCall& call, std::string_view message);
void note(const StageCall& call, std::string_view message);

/// An option that holds a whole number from `least` to `most`. Throws UsageError "--option TEXT: expected ..." for another
/// value, as those below. The option's value is a string: program_options would take -1 for a
/// large number.
std::uint64_t count_option(const StageCall& call, const std::string& option, std::uint64_t least = 0,
                           std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// A number from `least` to `most`.
double number_option(const StageCall& call, const std::string& option, double least, double most);

/// A finite number above 0 and at most `most`, or std::nullopt where the option was not given. `unit` is that
/// of the number, for the message.
std::optional<double> positive_option(const StageCall& call, const std::string& option, const std::string& unit,
                                      double most = std::numeric_limits<double>::infinity());

}  // namespace flightwatt::cli
