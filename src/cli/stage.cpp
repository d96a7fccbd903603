#include "cli/stage.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_use.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

namespace po = boost::program_options;

constexpr const char* inputs_option = "inputs";

/// Says what went wrong, and where; returns the exit code that stands for it.
ExitCode failed(ExitCode code, const std::string& program, const std::string& message, const std::string& where = "") {
    const auto place = where.empty() ? "" : where + ": ";
    fmt::print(stderr, "{}: {}error: {}\n", program, one_line(place), one_line(message));
    return code;
}

StageCall parse(int argc, char** argv, const StageDefinition& definition, po::options_description& visible) {
    StageCall call;
    call.program = "flightwatt-" + definition.name;
    visible.add_options()("output,o", output_file("FILE"), definition.output_help.c_str())(
        "json", "print the summary as JSON")("help,h", "show this help")("version", "show the version");
    po::options_description all = visible;
    all.add_options()(inputs_option, po::value<std::vector<std::string>>());
    po::positional_options_description positional;
    positional.add(inputs_option, -1);
    const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
    po::store(po::command_line_parser(argc, argv).options(all).positional(positional).style(style).run(), call.options);
    po::notify(call.options);
    call.json = call.has("json");
    call.output = call.maybe<std::string>("output");
    if (call.output == "-") call.output.reset();  // as everywhere: the standard output
    if (call.has(inputs_option)) call.inputs = call.get<std::vector<std::string>>(inputs_option);
    return call;
}

std::string usage_line(const StageDefinition& definition) {
    return fmt::format("usage: flightwatt {} {} [options]", definition.name, definition.arguments);
}

/// Tells which files the user named are read and written: a result that replaces what it was made from would lose a
/// log for good.
void declare_files(const StageCall& call, const po::options_description& options) {
    watch_file_use();
    for (const auto& input : call.inputs) note_input(input);
    const auto visit = [&](FileRole role, const auto& use) {
        for (const auto& option : options.options()) {
            const auto* file = dynamic_cast<const FileValue*>(option->semantic().get());
            const auto name = option->long_name();
            if (file != nullptr && file->role() == role && call.has(name)) use(call.get<std::string>(name), name);
        }
    };
    visit(FileRole::input, [](const std::string& file, const std::string&) { note_input(file); });
    visit(FileRole::output, [](const std::string& file, const std::string& name) {
        if (file != "-") declare_output(file, "--" + name);
    });
}

int run(int argc, char** argv, const StageDefinition& definition, const StageBody& body) {
    po::options_description visible = definition.options;
    const auto call = parse(argc, argv, definition, visible);
    if (call.has("help")) {
        std::ostringstream options;
        options << visible;
        print(fmt::format("{}\n\n{}\n\n{}", usage_line(definition), definition.description, options.str()));
        return ok;
    }
    if (call.has("version")) {
        print(fmt::format("{} {}\n", call.program, FLIGHTWATT_VERSION));
        return ok;
    }
    if (call.inputs.size() < definition.min_inputs) {
        throw UsageError(fmt::format("no input given; {}", usage_line(definition)));
    }
    if (call.inputs.size() > definition.max_inputs) {
        throw UsageError(
            fmt::format("unexpected argument '{}'; {}", call.inputs[definition.max_inputs], usage_line(definition)));
    }
    declare_files(call, visible);
    return body(call);
}

}  // namespace

int run_guarded(const std::string& program, const std::function<int()>& body) {
    std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is then a failed write, reported below
    try {
        const int code = body();
        if (std::fflush(stdout) != 0 || std::fclose(stdout) != 0) {
            throw OutputError(fmt::format("cannot write the standard output: {}", std::strerror(errno)));
        }
        return code;
    } catch (const InputError& error) {
        const auto hint = error.hint().empty() ? "" : "; " + error.hint();
        return failed(input_rejected, program, error.what() + hint, to_string(error.where()));
    } catch (const NoAnswerError& error) {
        return failed(no_answer, program, error.what());
    } catch (const UsageError& error) {
        return failed(usage_error, program, error.what());
    } catch (const po::error& error) {
        return failed(usage_error, program, fmt::format("{}; see --help", error.what()));
    } catch (const OutputError& error) {
        return failed(internal_error, program, error.what());
    } catch (const std::exception& error) {
        return failed(internal_error, program, fmt::format("internal error: {}", error.what()));
    }
}

int run_stage(int argc, char** argv, const StageDefinition& definition, const StageBody& body) {
    return run_guarded("flightwatt-" + definition.name, [&] { return run(argc, argv, definition, body); });
}

void print(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) {
        throw OutputError(fmt::format("cannot write the standard output: {}", std::strerror(errno)));
    }
}

void write_result(const StageCall& call, std::string_view content) {
    if (call.output) {
        write_file_atomically(*call.output, content);
    } else if (!call.json) {
        print(content);
    }
}

std::string one_line(std::string_view text) {
    std::string line(text);
    std::ranges::replace_if(
        line, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    return line;
}

void warn(const StageCall& call, std::string_view message) {
    fmt::print(stderr, "{}: warning: {}\n", call.program, one_line(message));
}

void note(const StageCall& call, std::string_view message) {
    fmt::print(stderr, "{}: {}\n", call.program, one_line(message));
}

}  // namespace flightwatt::cli
