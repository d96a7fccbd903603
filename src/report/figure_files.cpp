#include "report/figure_files.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_use.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::report {
namespace {

/// Runs a program of the PATH with its output on our standard error; false if it is not there. Throws OutputError where
/// it fails.
bool ran(const std::vector<std::string>& command) {
    std::vector<char*> arguments;
    arguments.reserve(command.size() + 1);
    for (const auto& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
    pid_t process = 0;
    const int failure = ::posix_spawnp(&process, arguments.front(), &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (failure == ENOENT) return false;
    if (failure != 0) {
        throw OutputError(fmt::format("cannot run {}: {}", command.front(), std::strerror(failure)));
    }
    int status = 0;
    while (::waitpid(process, &status, 0) < 0) {
        if (errno != EINTR) {
            throw OutputError(fmt::format("lost sight of {}: {}", command.front(), std::strerror(errno)));
        }
    }
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    constexpr int not_there = 127;  // of a shell's
    if (code == not_there) return false;
    if (code != 0) throw OutputError(fmt::format("{} failed with exit code {}", command.front(), code));
    return true;
}

/// The specification with the light theme in it: a file that any Vega-Lite draws.
std::string standalone(const Figure& figure, const VegaJson& theme) {
    auto spec = figure.spec;
    spec["config"] = theme.at("light");
    return spec.dump(1, ' ', false, VegaJson::error_handler_t::replace) + "\n";
}

}  // namespace

FigureFiles write_figures(const std::vector<Section>& sections, const WebFiles& web,
                          const std::filesystem::path& folder) {
    for (const auto& section : sections) {
        for (const auto& figure : section.figures) {
            for (const auto* ending : {".vl.json", ".svg", ".pdf"}) declare_output(folder / (figure.id + ending));
        }
    }
    make_directories(folder);
    const auto theme = VegaJson::parse(web.theme);
    FigureFiles files;
    for (const auto& section : sections) {
        for (const auto& figure : section.figures) {
            write_file_atomically(folder / (figure.id + ".vl.json"), standalone(figure, theme));
            ++files.figures;
        }
    }
    // These alone: the folder may hold others' figures.
    std::vector<std::string> render{"node", (web.folder / "render.mjs").string(), folder.string()};
    for (const auto& section : sections)
        for (const auto& figure : section.figures) render.push_back(figure.id);
    files.has_svg = ran(render);
    if (!files.has_svg) return files;
    for (const auto& section : sections) {
        for (const auto& figure : section.figures) {
            const auto svg = (folder / (figure.id + ".svg")).string();
            const auto pdf = (folder / (figure.id + ".pdf")).string();
            files.has_pdf = ran({"rsvg-convert", "--format", "pdf", "--output", pdf, svg});
            if (!files.has_pdf) return files;
        }
    }
    return files;
}

}  // namespace flightwatt::report
