#include "base/atomic_file.h"
#include "base/error.h"
#include "cli/stage.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

namespace flightwatt::cli {

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
    std::replace_if(
        line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    return line;
}

void warn(const StageCall& call, std::string_view message) {
    fmt::print(stderr, "{}: warning: {}\n", call.program, one_line(message));
}

void note(const StageCall& call, std::string_view message) {
    fmt::print(stderr, "{}: {}\n", call.program, one_line(message));
}

}  // namespace flightwatt::cli
