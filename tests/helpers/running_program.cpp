#include "helpers/running_program.h"

#include "helpers/test_paths.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

namespace flightwatt::test {
namespace {

/// A file without a name.
class UnnamedFile {
  public:
    UnnamedFile() : file_(std::tmpfile()) {
        if (file_ == nullptr) throw std::runtime_error("no temporary file");
    }
    ~UnnamedFile() { std::fclose(file_); }
    UnnamedFile(const UnnamedFile&) = delete;
    UnnamedFile& operator=(const UnnamedFile&) = delete;

    int descriptor() const { return ::fileno(file_); }
    std::string content() const {
        std::string text;
        std::rewind(file_);
        for (int c = std::fgetc(file_); c != EOF; c = std::fgetc(file_)) text.push_back(static_cast<char>(c));
        return text;
    }

  private:
    std::FILE* file_;
};

}  // namespace

std::string shell_quoted(const std::filesystem::path& path) {
    std::string word = "'";
    for (const char c : path.string()) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
}

ProgramResult run_shell(const std::string& command, const std::filesystem::path& folder,
                        const std::string& environment) {
    const UnnamedFile out;
    const UnnamedFile err;
    const auto line = "export " + environment + " PATH=" + shell_quoted(programs_dir()) + ":\"$PATH\"; " + command;
    const auto child = ::fork();
    if (child == 0) {
        ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
        ::dup2(out.descriptor(), STDOUT_FILENO);
        ::dup2(err.descriptor(), STDERR_FILENO);
        if (::chdir(folder.c_str()) != 0) ::_exit(98);
        ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
        ::_exit(99);
    }
    ProgramResult result;
    result.code = exit_code_of(child);
    result.out = out.content();
    result.err = err.content();
    return result;
}

::pid_t start_program(const std::string& name, const std::vector<std::string>& arguments,
                      const std::filesystem::path& folder) {
    const auto create = [&](const char* path) {
        return ::open((folder / path).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    };
    const int out = create("stdout");  // before the program starts: a test may read them at once
    const int err = create("stderr");
    const auto child = ::fork();
    if (child != 0) {
        ::close(out);
        ::close(err);
        return child;
    }
    std::signal(SIGINT, SIG_DFL);  // which a background job of a shell ignores
    ::dup2(out, STDOUT_FILENO);
    ::dup2(err, STDERR_FILENO);
    if (::chdir(folder.c_str()) != 0) ::_exit(98);
    const auto program = programs_dir() / name;
    std::vector<std::string> words = arguments;
    words.insert(words.begin(), name);
    std::vector<char*> pointers;
    for (auto& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    ::execv(program.c_str(), pointers.data());
    ::_exit(99);
}

int wait_status_of(::pid_t child) {
    int status = -1;
    ::waitpid(child, &status, 0);
    return status;
}

int exit_code_of(::pid_t child) {
    const int status = wait_status_of(child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int run_program(const std::string& name, const std::vector<std::string>& arguments,
                const std::filesystem::path& folder) {
    return exit_code_of(start_program(name, arguments, folder));
}

int processes_with(const std::string& marker) {
    int count = 0;
    std::error_code absent;
    for (std::filesystem::directory_iterator it("/proc", absent), end; it != end; it.increment(absent)) {
        std::ifstream file(it->path() / "cmdline");
        // A process may end while it is read; getline then fails, an iterator on the buffer would throw.
        constexpr char no_separator = '\1';
        std::string line;
        std::getline(file, line, no_separator);
        if (line.find(marker) != std::string::npos) ++count;
    }
    return count;
}

std::string new_marker() {
    static int next = 0;
    return fmt::format("9{:07}.{}", ::getpid(), ++next);
}

bool wait_until(const std::function<bool()>& condition) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > until) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
}

}  // namespace flightwatt::test
