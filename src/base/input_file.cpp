#include "base/input_file.h"

#include "base/error.h"
#include "base/overwrite_guard.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <regex>
#include <set>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/auxv.h>
#include <sys/stat.h>
#include <unistd.h>

namespace flightwatt {
namespace {

/// Files with the ending of a missing file, in its folder.
std::string files_beside(const std::filesystem::path& path) {
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    std::set<std::string> names;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (entry->path().extension() == path.extension()) names.insert(entry->path().filename().string());
    if (error) return fmt::format("there is no folder {}", folder.string());
    return names.empty() ? "" : "its folder has " + short_list({names.begin(), names.end()});
}

[[noreturn]] void cannot_read(const std::filesystem::path& path, int error) {
    throw InputError({path.string()}, fmt::format("cannot be read: {}", std::strerror(error)),
                     error == ENOENT ? files_beside(path) : "");
}

[[noreturn]] void refuse_folder(const std::filesystem::path& path) {
    std::error_code none;
    if (std::filesystem::exists(path / "batch.json", none))
        throw InputError({path.string()}, "is a folder of flightwatt batch, expected a file",
                         "its model is model.toml in it, its flights are in flights/");
    throw InputError({path.string()}, "is a folder, expected a file", "name a file in it");
}

/// A descriptor that the program was started with, such as the shell's <(COMMAND): who writes it is there.
bool is_open_already(const std::filesystem::path& path) {
    const auto folder = path.parent_path();
    return folder == "/dev/fd" || folder == "/proc/self/fd" || path == "/dev/stdin";
}

/// Up to `most` bytes more; 0 at the end.
std::size_t read_some(const InputFile& file, char* to, std::size_t most) {
    while (true) {
        const auto count = ::read(file.descriptor(), to, most);
        if (count >= 0) return static_cast<std::size_t>(count);
        if (errno != EINTR) cannot_read(file.path(), errno);
    }
}

struct KnownFile {
    FileKind kind;
    std::string name;
    std::string remedy;  ///< how to get one; of foreign files what to do with it
    std::string sign;    ///< regular expression that finds it; empty: none does
};

/// In the order of the search. A recording of MAVLink begins with a time of this century in microseconds.
const std::vector<KnownFile>& known_files() {
    using enum FileKind;
    constexpr auto path_remedy =
        "`flightwatt check` answers whether it fits, `flightwatt new-mission --plan` makes a mission of it";
    static const std::vector<KnownFile> files{
        {foreign, "a bag of ROS", "", "^#ROSBAG"},
        {foreign, "a blackbox log of Betaflight or INAV", "", "^H Product:Blackbox"},
        {foreign, "a MATLAB file", "", "^MATLAB 5"},
        {foreign, "an HDF5 file", "", "^\x89HDF"},
        {foreign, "an SQLite database", "", "^SQLite format 3"},
        {foreign, "a PDF document", "", "^%PDF"},
        {foreign, "a picture", "", "^\x89PNG"},
        {foreign, "a picture", "", "^\xFF\xD8\xFF"},
        {foreign, "a program", "",
         "^\x7F"
         "ELF"},
        {log, "a log", "expected a .data log, .LOG or .tlm of Paparazzi, a .bin, .ulg or .tlog, or a CSV of a flight",
         "(^|\n)([0-9.]+ [^ \n]+ [A-Z]|FMT, ?128)|^(\xA3\x95\x80|ULog\x01|\\x00[\\x03-\\x0E][\\s\\S]{6}[\xFD\xFE])"},
        {unknown, "", "", "[\\x00-\\x08]"},  // binary: a log, or nothing that is known
        {mission, "a mission", "write one with `flightwatt new-mission`", R"((^|\n)\[*(battery|mechanical)\b)"},
        {mechanical_model, "a mechanical model", "fit one with `flightwatt batch` or `fit`", R"((^|\n)\[*takeoff\b)"},
        {battery, "a battery", "identify one with `flightwatt battery`", R"((^|\n)resistance_ohm\b)"},
        {disturbances, "a list of disturbances", "missions/disturbances/ has examples", R"((^|\n)\[+disturbance\b)"},
        {specification, "a specification of flightwatt profile", "docs/formats.md describes one",
         R"((^|\n)(\[sampler|idle_s|above_idle))"},
        {profile, "a power profile", "measure one with `flightwatt profile`", ""},
        {foreign, "the definitions of a log (.log)", "name its .data instead", "<configuration"},
        {foreign, "a flight plan of Paparazzi", path_remedy, "<flight_plan"},
        {foreign, "a web page", "", "<(!DOCTYPE )?html"},
        {foreign, "an XML file", "", R"(^\s*<)"},
        {foreign, "a plan of QGroundControl", path_remedy, "\"fileType\""},
        {foreign, "a JSON file", "", R"(^\s*\{)"},
        {foreign, "a list of waypoints of ArduPilot", path_remedy, "^QGC WPL"},
        {plan, "a plan",
         "expected a .plan, .waypoints, .kml or .geojson, a flight plan of Paparazzi (.xml), or a CSV of waypoints",
         ""},
        {table, "a table (CSV)", "", R"(^(#[^\n]*\n)*[^#=\n]*,)"}};
    return files;
}

/// The file whose sign the text has; nullptr: none. The beginning of a text decides; a longer one would take the
/// recursion of regular expressions far.
const KnownFile* find_known_file(std::string_view text) {
    static const auto signs = [] {
        std::vector<std::regex> all;
        for (const auto& file : known_files()) all.emplace_back(file.sign);
        return all;
    }();
    const auto begin = text.substr(0, 4096);
    for (std::size_t i = 0; i < signs.size(); ++i) {
        const auto& sign = known_files()[i].sign;
        // Not sought further on, which would take far longer.
        const auto where =
            sign.starts_with('^') ? std::regex_constants::match_continuous : std::regex_constants::match_default;
        if (!sign.empty() && std::regex_search(begin.begin(), begin.end(), signs[i], where)) return &known_files()[i];
    }
    return nullptr;
}

}  // namespace

InputFile::InputFile(const std::filesystem::path& path) : path_(path) {
    register_input(path);
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);  // a pipe would wait for who writes it
    if (descriptor_ < 0) cannot_read(path, errno);
    struct stat status {};
    const int error = ::fstat(descriptor_, &status) == 0 ? 0 : errno;
    is_regular_ = S_ISREG(status.st_mode);
    if (is_regular_) size_ = static_cast<std::size_t>(status.st_size);
    const bool is_read = is_regular_ || (S_ISFIFO(status.st_mode) && is_open_already(path));
    if (error == 0 && is_read && ::fcntl(descriptor_, F_SETFL, O_RDONLY) == 0) return;
    ::close(descriptor_);  // no destructor runs behind a constructor that throws
    if (error != 0) cannot_read(path, error);
    if (S_ISDIR(status.st_mode)) refuse_folder(path);
    const auto* const kind = S_ISFIFO(status.st_mode) ? "pipe" : "device";
    throw InputError({path.string()}, fmt::format("is a {}, expected a file", kind));
}

InputFile::~InputFile() { ::close(descriptor_); }

void InputFile::require_not_truncated() const {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) cannot_read(path_, errno);
    if (!is_regular_ || static_cast<std::size_t>(status.st_size) >= size_) return;
    throw InputError({path_.string()},
                     fmt::format("was cut from {} to {} bytes while it was read", size_, status.st_size),
                     "run again when it is whole");
}

std::string read_file(const std::filesystem::path& path, std::size_t max_bytes, std::string_view hint) {
    constexpr std::size_t min_step = 65536;
    const InputFile file(path);
    const auto refuse_more = [&](std::size_t bytes) {
        if (bytes <= max_bytes) return;
        throw InputError({path.string()},
                         fmt::format("holds more than {:.4g} MB", static_cast<double>(max_bytes) / 1e6),
                         std::string(hint));
    };
    refuse_more(file.size());
    std::string content;
    std::size_t used = 0;
    for (std::size_t count = 1; count > 0; used += count) {
        refuse_more(used);
        if (used == content.size()) content.resize(std::max({file.size() + 1, used + used / 2, min_step}));
        count = read_some(file, content.data() + used, content.size() - used);
    }
    file.require_not_truncated();
    content.resize(used);
    return content;
}

std::error_code open_error(const std::filesystem::path& path) {
    return ::faccessat(AT_FDCWD, path.c_str(), R_OK, AT_EACCESS) == 0 ? std::error_code()
                                                                      : std::error_code(errno, std::generic_category());
}

std::filesystem::path executable_folder() {
    std::error_code error;
    auto program = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) {  // no /proc, as in an empty root: the path that the program was started by
        const auto* started_by =
            reinterpret_cast<const char*>(::getauxval(AT_EXECFN));  // NOLINT(performance-no-int-to-ptr)
        if (started_by != nullptr) program = std::filesystem::canonical(started_by, error);
    }
    return error ? std::filesystem::path() : program.parent_path();
}

std::filesystem::path data_folder(const std::string& name, const char* variable, const std::string& what) {
    const char* named = std::getenv(variable);
    auto folder = named != nullptr ? std::filesystem::path(named)
                                   : executable_folder().parent_path() / "share" / "flightwatt" / name;
    std::error_code error;
    if (std::filesystem::is_directory(folder, error)) return folder;
    throw InputError({folder.string()}, what + " are not there",
                     fmt::format("{} can name the project's folder {}/", variable, name));
}

FileKind kind_of_text(std::string_view text) {
    const auto* found = find_known_file(text);
    return found != nullptr ? found->kind : FileKind::unknown;
}

void require_kind(std::string_view text, FileKind expected, const std::string& file) {
    const auto& wanted = *std::ranges::find(known_files(), expected, &KnownFile::kind);
    const bool has_columns = expected == FileKind::log || expected == FileKind::profile || expected == FileKind::plan;
    if ((!has_columns || expected == FileKind::plan) && text.find_first_not_of(" \t\r\n") == std::string_view::npos)
        throw InputError({file}, fmt::format("is empty, expected {}", wanted.name), wanted.remedy);
    const auto* found = find_known_file(text);
    if (expected == FileKind::plan && found != nullptr && found->kind == FileKind::unknown)
        throw InputError({file}, "is binary, not a plan", wanted.remedy);
    if (found == nullptr || found->kind == expected || found->kind == FileKind::unknown) return;
    if (has_columns && found->kind == FileKind::table) return;
    const bool has_own_remedy = found->kind == FileKind::foreign && !found->remedy.empty();
    throw InputError({file}, fmt::format("is {}, not {}", found->name, wanted.name),
                     has_own_remedy ? found->remedy : wanted.remedy);
}

}  // namespace flightwatt
