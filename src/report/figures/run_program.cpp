#include "report/figures/run_program.h"

#include "base/error.h"

#include <cstdio>
#include <system_error>

#include <boost/process/args.hpp>
#include <boost/process/io.hpp>
#include <boost/process/system.hpp>
#include <fmt/format.h>

namespace flightwatt::report {

bool run_program(std::vector<std::string> command) {
    namespace bp = boost::process;
    constexpr int not_installed = 127;
    const auto program = command.front();
    command.insert(command.begin(), {"-c", R"(command -v "$0" > /dev/null || exit 127; exec "$0" "$@")"});
    std::error_code error;
    const int code = bp::system("/bin/sh", bp::args(command), bp::std_out > stderr, error);
    if (error) throw OutputError(fmt::format("cannot run {}: {}", program, error.message()));
    if (code != 0 && code != not_installed)
        throw OutputError(fmt::format("{} failed with exit code {}", program, code));
    return code == 0;
}

}  // namespace flightwatt::report
