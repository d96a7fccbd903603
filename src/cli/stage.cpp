#include "cli/stage.h"

#include "base/atomic_file.h"
#include "base/overwrite_guard.h"
#include "base/parallel.h"
#include "base/temporary_folder.h"
#include "cli/screen/diagnostic_lines.h"
#include "cli/terminal.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <new>
#include <utility>

#include <boost/algorithm/string/replace.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

namespace flightwatt::cli {

/// The commit that the program was built of; empty where it is unknown. Programs alone define it (cmake/commit.cmake),
/// so that a new commit relinks them and compiles nothing.
[[gnu::weak]] const char* commit();

namespace {

namespace po = boost::program_options;

/// Once the reader of the standard output has left (head): what is still printed goes nowhere, everything else is done
/// to its end, and then the program ends as SIGPIPE ends programs.
bool reader_has_left = false;

/// --quiet was given.
bool is_quiet = false;

/// Prints a message for people, on a terminal in lines of its width, errors and warnings with their colours; elsewhere in
/// one line behind the program: a log of several stages then shows which it was.
void print_message(const std::string& program, const std::string& text, bool is_finding = false) {
    auto message = one_line(text);
    const bool is_terminal = ::isatty(STDERR_FILENO) == 1;
    message = is_terminal ? wrapped(message, terminal_columns(stderr)) : program + ": " + message;
    const bool is_warning = text.starts_with("warning: ");
    const std::string word = is_warning ? "warning:" : "error:";
    if (const auto at = message.find(word); is_finding && is_coloured(stderr) && at != std::string::npos)
        message.replace(at, word.size(), (is_warning ? "\x1b[33m" : "\x1b[31m") + word + "\x1b[0m");
    print_lines(message + '\n');
}

/// Prints an error with its location; returns the exit code.
ExitCode failed(ExitCode code, const std::string& program, const std::string& message, const std::string& where = "") {
    const auto prefix = where.empty() ? "" : where + ": ";
    print_message(program, fmt::format("{}error: {}", prefix, truncated(message)), true);
    return code;
}

/// Prints and clears what the call collected.
void print_diagnostics(const StageCall& call) {
    const auto diagnostics = std::exchange(*call.diagnostics, {});
    for (const auto& line : diagnostic_lines(diagnostics, call.notes)) print_message(call.program, line, true);
    const auto notes = call.notes || is_quiet ? "" : notes_line(diagnostics);
    if (!notes.empty()) print_message(call.program, notes);
}

/// A standard stream that was closed before the start would become the first file that is opened, a log or a result.
/// The streams opened here instead cannot be written, so that a result for a closed standard output is an error.
void occupy_closed_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF) ::open("/dev/null", O_RDONLY);
    }
}

[[noreturn]] void cannot_print() {
    throw OutputError(fmt::format("cannot write the standard output: {}", std::strerror(errno)));
}

[[noreturn]] void end_by_broken_pipe() {
    constexpr int killed_by_signal = 128;  // what shells add to the signal
    std::signal(SIGPIPE, SIG_DFL);
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGPIPE);
    ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
    std::raise(SIGPIPE);
    ::_exit(killed_by_signal + SIGPIPE);
}

void flush_standard_output() {
    if (reader_has_left || std::fflush(stdout) == 0) return;
    if (errno != EPIPE) cannot_print();
    reader_has_left = true;
}

void close_standard_output() {
    flush_standard_output();
    if (reader_has_left) end_by_broken_pipe();
    if (std::fclose(stdout) != 0) cannot_print();
}

std::string usage_line(const StageDefinition& definition) {
    return fmt::format("usage: flightwatt {} {} [options]", definition.name, definition.arguments);
}

/// Registers the files that the user named: a result that replaces what it was made from would lose a log for good.
void register_files(const StageCall& call, const Options& options, const Options::Given& given) {
    enable_overwrite_guard();
    for (const auto& input : call.inputs) register_input(input);
    const auto register_role = [&](FileRole role, const auto& use) {
        for (const auto& [name, files] : given.options)
            if (options.find(name)->file == role)
                for (const auto& file : files) use(file, "--" + name);
    };
    register_role(FileRole::input, [](const auto& file, const auto&) { register_input(file); });
    register_role(FileRole::output, [](const auto& file, const auto& name) {
        if (file != "-") register_output(file, name);
    });
}

/// A copy of the standard input as a file, which the readers of logs can map. It is removed with this object.
class StandardInputFile {
  public:
    StandardInputFile() {
        std::ofstream copy(file(), std::ios::binary);
        if (std::cin.peek() != std::char_traits<char>::eof()) copy << std::cin.rdbuf();
        copy.close();
        if (!copy)
            throw OutputError(fmt::format("cannot copy the standard input to {}: {}", file(), std::strerror(errno)));
    }
    std::string file() const { return folder_.path() / "standard_input.data"; }

  private:
    TemporaryFolder folder_;
};

/// The options of every stage.
struct CommonOptions {
    bool json_usage = false;
    bool json_schema = false;
    bool quiet = false;
    bool help = false;
    bool help_all = false;
    bool version = false;
    std::size_t jobs = 0;
};

void add_common_options(StageDefinition& stage, StageCall& call, CommonOptions& common) {
    constexpr double max_jobs = 256;
    auto& options = stage.options;
    options.begin_group("Common options");
    options.add("output,o", call.output, {.value = stage.output_value, .file = FileRole::output}, stage.output_help);
    options.add("json", call.json, "print the summary as JSON");
    if (stage.shows_table) options.add("wide", call.wide, "on a terminal: all columns, also beyond its width");
    if (stage.uses_threads)
        options.add("jobs,j", common.jobs, {.value = "N", .max = max_jobs}, "threads; 0: one for each core");
    options.add("quiet,q", common.quiet, "print no notes and no progress; warnings and errors remain");
    options.add("notes", call.notes, "list all notes, and each warning of each flight", {.excludes = {"quiet"}});
    options.add("help,h", common.help, "show this help");
    options.add("help-all", common.help_all, "show this help, with expert options");
    options.add("json-usage", common.json_usage, "print inputs and options of this stage as JSON");
    if (stage.json_schema != nullptr) options.add("json-schema", common.json_schema, "print the JSON schema of --json");
    options.add("version", common.version, "show the version");
}

std::string help_text(const StageDefinition& stage, bool all) {
    auto text = fmt::format("{}\n\n{}\n\n{}", usage_line(stage), fitted(stage.description, stdout),
                            stage.options.help_text(all, terminal_columns(stdout)));
    const auto experts = std::ranges::count(stage.options.all(), true, &Option::is_expert);
    if (!all && experts > 0) text += fmt::format("--help-all shows {} more options.\n\n", experts);
    if (!stage.examples.empty()) text += "Examples:\n";
    for (const auto& example : stage.examples) text += fmt::format("  {}\n", example);
    return text;
}

Json usage_json(const StageDefinition& stage) {
    return {{"format", 1},
            {"stage", stage.name},
            {"usage", fmt::format("flightwatt {} {} [options]", stage.name, stage.arguments)},
            {"description", stage.description},
            {"min_inputs", stage.min_inputs},
            {"max_inputs", stage.max_inputs},
            {"examples", stage.examples},
            {"options", stage.options.json()}};
}

/// Whether the user asked for information on the stage, which is then printed.
bool print_information(const StageDefinition& stage, const CommonOptions& common) {
    if (common.help || common.help_all)
        print(help_text(stage, common.help_all));
    else if (common.json_usage)
        print(json_text(usage_json(stage)));
    else if (common.json_schema)
        print(json_text(stage.json_schema()));
    else if (common.version)
        print(fmt::format("flightwatt-{} {}\n", stage.name, version_text()));
    else
        return false;
    return true;
}

void check_input_count(const StageDefinition& stage, const std::vector<std::string>& inputs) {
    if (inputs.size() < stage.min_inputs) {
        const auto found = inputs.empty() ? std::string("no input given")
                                          : fmt::format("{} given, expected {}", inputs.size(), stage.min_inputs);
        throw UsageError(fmt::format("{}; {}", found, usage_line(stage)));
    }
    if (inputs.size() > stage.max_inputs)
        throw UsageError(fmt::format("unexpected argument '{}'; {}", inputs[stage.max_inputs], usage_line(stage)));
}

/// States what a stage wrote and what can follow.
void note_written(const StageDefinition& stage, const StageCall& call) {
    if (!stage.next || !call.output || call.json) return;
    auto next = stage.next(call);
    boost::algorithm::replace_first(next, "{}", shell_quoted(*call.output));
    if (!call.inputs.empty()) boost::algorithm::replace_first(next, "{in}", shell_quoted(call.inputs.front()));
    note(call, fmt::format("{} is written{}{}", *call.output, next.empty() ? "" : "; next: ", next));
}

int run(int argc, char** argv, StageDefinition& stage, const StageBody& body) {
    StageCall call;
    CommonOptions common;
    add_common_options(stage, call, common);
    if (argc == 2 && std::string_view(argv[1]) == "--list-options") {
        print(stage.options.list_text());
        return ok;
    }
    const auto given = stage.options.parse(argc, argv);
    for (const auto& [name, texts] : given.options)
        if (texts.front() == "true" && stage.options.find(name)->type == "flag")
            stage.options.find(name)->assign(texts);
    if (print_information(stage, common)) return ok;
    stage.options.assign(given);
    check_input_count(stage, given.inputs);
    call.program = "flightwatt-" + stage.name;
    call.command = "flightwatt " + stage.name;
    for (int i = 1; i < argc; ++i) call.command += " " + shell_quoted(argv[i]);
    for (const auto& [name, texts] : given.options) call.given.insert(name);
    call.inputs = given.inputs;
    call.is_live = stage.is_live;
    if (call.output == "-") call.output.reset();
    is_quiet = common.quiet;
    if (common.quiet) hide_progress();
    limit_threads(common.jobs);
    std::optional<StandardInputFile> standard_input;
    for (auto& input : call.inputs) {
        if (!stage.reads_logs || input != "-" || standard_input) continue;
        standard_input.emplace();
        input = standard_input->file();
    }
    register_files(call, stage.options, given);
    int code = ok;
    try {
        code = body(call);
        flush_standard_output();  // the result comes first
    } catch (...) {
        print_diagnostics(call);
        throw;
    }
    print_diagnostics(call);
    call.inputs = given.inputs;  // as they were typed
    if (code == ok || code == input_rejected) note_written(stage, call);
    return code == ok && !call.skipped->empty() ? input_rejected : code;
}

/// Defect of an input, with its remedy.
std::string reason_of(const InputError& error) {
    return error.hint().empty() ? std::string(error.what()) : fmt::format("{}; {}", error.what(), error.hint());
}

}  // namespace

int run_guarded(const std::string& program, const std::function<int()>& body) {
    // A closed pipe and a file beyond the limit (ulimit -f) are then failed writes: see print().
    for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
    occupy_closed_streams();
    try {
        const int code = body();
        close_standard_output();
        return code;
    } catch (const InputError& error) {
        return failed(input_rejected, program, reason_of(error), to_string(error.where()));
    } catch (const NoResultError& error) {
        return failed(no_answer, program, error.what());
    } catch (const UsageError& error) {
        return failed(usage_error, program, error.what());
    } catch (const po::error& error) {
        return failed(usage_error, program, fmt::format("{}; see --help", error.what()));
    } catch (const OutputError& error) {
        return failed(internal_error, program, error.what());
    } catch (const std::filesystem::filesystem_error& error) {
        return failed(input_rejected, program, "cannot be used: " + error.code().message(), error.path1().string());
    } catch (const std::bad_alloc&) {
        return failed(internal_error, program, "there is not enough memory");
    } catch (const std::exception& error) {
        return failed(internal_error, program, fmt::format("internal error: {}", error.what()));
    }
}

std::string version_text() {
    const std::string_view known = commit != nullptr ? commit() : "";
    return known.empty() ? FLIGHTWATT_VERSION : fmt::format(FLIGHTWATT_VERSION " ({})", known);
}

int run_stage(int argc, char** argv, StageDefinition definition, const StageBody& body) {
    return run_guarded("flightwatt-" + definition.name, [&] { return run(argc, argv, definition, body); });
}

void skip_input(const StageCall& call, const std::string& file, const InputError& error) {
    add_diagnostic(call, {Severity::error, "skipped", reason_of(error) + " (skipped)", to_string(error.where())});
    call.skipped->push_back({file, reason_of(error)});
}

void print(std::string_view text) {
    if (reader_has_left || std::fwrite(text.data(), 1, text.size(), stdout) == text.size()) return;
    if (errno != EPIPE) cannot_print();
    reader_has_left = true;
}

bool print_flushed(std::string_view text) {
    print(text);
    flush_standard_output();
    return !reader_has_left;
}

void write_result(const StageCall& call, std::string_view content) {
    if (call.output) {
        write_file_atomically(*call.output, content);
    } else if (!call.json) {
        print(content);
    }
}

Json json_document(const StageCall& call, const Json& record) {
    constexpr std::string_view prefix = "flightwatt-";
    Json json{{"format", json_format}, {"stage", call.program.substr(prefix.size())}};
    json.update(record);
    return json;
}

Json json_schema(std::vector<Json> forms) {
    for (auto& form : forms) {
        Json properties{{"format", {{"const", json_format}, {"description", "format of this JSON"}}},
                        {"stage", {{"type", "string"}, {"description", "name of the stage"}}}};
        properties.update(form["properties"]);
        form["properties"] = std::move(properties);
        form["required"].insert(form["required"].begin(), {"format", "stage"});
    }
    Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}};
    if (forms.size() == 1)
        schema.update(forms.front());
    else
        schema["anyOf"] = std::move(forms);
    return schema;
}

std::string shell_quoted(std::string_view file) {
    if (!file.empty() && file.find_first_of(" \t\n'\"\\$`&;|<>()*?[]#~!{}") == std::string_view::npos)
        return std::string(file);
    std::string quoted = "'";
    for (const char c : file) c == '\'' ? quoted += R"('\'')" : quoted += c;
    return quoted + "'";
}

void add_diagnostic(const StageCall& call, Diagnostic diagnostic) {
    call.diagnostics->push_back(std::move(diagnostic));
    if (call.is_live) print_diagnostics(call);
}

void warn(const StageCall& call, std::string_view message) {
    add_diagnostic(call, {.severity = Severity::warning, .text = std::string(message)});
}

void note(const StageCall& call, std::string_view message) {
    if (is_quiet) return;
    print_message(call.program, std::string(message));
}

void print_lines(std::string_view lines) { std::fwrite(lines.data(), 1, lines.size(), stderr); }

}  // namespace flightwatt::cli
