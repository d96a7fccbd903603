#include "compute/power_sampler.h"

#include "base/error.h"
#include "base/number.h"
#include "base/units.h"
#include "compute/processes/supervised_processes.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <termios.h>
#include <unistd.h>

namespace flightwatt::compute {
namespace {

/// In the order of SamplerKind.
const std::vector<std::string> kind_names{"auto", "ina3221", "rapl", "command", "recorded"};

SamplerKind kind_of(const TomlTable& table) {
    const auto name = table.optional_string("kind");
    if (!name) {
        return table.has("command") ? SamplerKind::command
               : table.has("file")  ? SamplerKind::recorded
                                    : SamplerKind::automatic;
    }
    const auto known = std::ranges::find(kind_names, *name);
    if (known != kind_names.end()) return static_cast<SamplerKind>(known - kind_names.begin());
    throw InputError(table.where("kind"), fmt::format("there is no sampler '{}'", *name),
                     meant_or(*name, kind_names, fmt::format("there are {}", fmt::join(kind_names, ", "))));
}

/// Refuses a key that has no effect with this kind.
void refuse_foreign_key(const TomlTable& table, std::string_view key, SamplerKind kind, SamplerKind its_kind) {
    if (!table.has(key) || kind == its_kind) return;
    throw InputError(table.where(key), fmt::format("{} belongs to the sampler '{}', not to '{}'", key,
                                                   to_string(its_kind), to_string(kind)));
}

/// Input of the whole module: TX2, Xavier NX, Orin NX and Nano; Nano; Nano under newer kernels.
constexpr std::string_view total_rails[] = {"VDD_IN", "POM_5V_IN", "5V_IN"};
/// Fed by another measured rail (AGX Orin: VIN_SYS_5V0), or not connected.
constexpr std::string_view derived_rails[] = {"VDDQ_VDD2_1V8AO", "NC"};
/// "package-0": a processor, whose parts (core, uncore) have counters of their own; psys contains it.
constexpr std::string_view package = "package";

using std::filesystem::path;

using Clock = std::chrono::steady_clock;

constexpr int channels = 3;  // of an INA3221

/// A supply line of a board, or a part of its processor. `read` returns the power [W] now; of an energy counter the
/// mean power since the last call, NaN at the first. Throws InputError naming the file.
struct PowerRail {
    std::string name;    ///< the board's or the driver's name for it, "VDD_IN", "package-0"
    std::string source;  ///< the files
    std::function<double(std::chrono::steady_clock::time_point)> read;
};

/// The first line; std::nullopt if it cannot be read.
std::optional<std::string> sysfs_text(const path& file) {
    constexpr std::size_t max_line = 256;
    std::ifstream stream(file);
    std::array<char, max_line> text{};
    if (!stream.getline(text.data(), text.size())) return std::nullopt;
    std::string line(text.data());
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    return line;
}

std::optional<double> sysfs_number(const path& file) {
    const auto text = sysfs_text(file);
    return text ? parse_number(*text) : std::nullopt;
}

double require_sysfs_number(const path& file) {
    const auto text = sysfs_text(file);
    if (!text) throw InputError({file.string()}, "the sensor cannot be read");
    if (const auto value = parse_number(*text)) return *value;
    throw InputError({file.string(), 1}, fmt::format("the sensor shows '{}', expected a number", *text));
}

/// The entries whose names begin with `prefix`, sorted; none if there is no such folder.
std::vector<path> sysfs_entries(const path& folder, std::string_view prefix = "") {
    std::vector<path> found;
    std::error_code none;
    for (std::filesystem::directory_iterator it(folder, none), end; it != end; it.increment(none)) {
        if (it->path().filename().string().starts_with(prefix)) found.push_back(it->path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

/// Adds a folder that exists, once: sysfs has the same device under several paths.
void add_device(std::vector<path>& devices, const path& folder) {
    std::error_code none;
    const auto is_same = [&](const path& device) { return std::filesystem::equivalent(device, folder, none); };
    if (!std::filesystem::exists(folder, none) || std::ranges::any_of(devices, is_same)) return;
    devices.push_back(folder);
}

/// Adds a rail by its power [mW], else by voltage [mV] and current [mA]; none where neither can be read.
void add_rail(const std::string& name, const path& power, const path& voltage, const path& current,
              std::vector<PowerRail>& rails) {
    if (sysfs_number(power)) {
        rails.push_back(
            {name, power.string(), [=](auto) { return units::watt_from_milliwatt(require_sysfs_number(power)); }});
    } else if (sysfs_number(voltage) && sysfs_number(current)) {
        rails.push_back({name, fmt::format("{} x {}", voltage.string(), current.filename().string()), [=](auto) {
                             return units::volt_from_millivolt(require_sysfs_number(voltage)) *
                                    units::ampere_from_milliampere(require_sysfs_number(current));
                         }});
    }
}

/// Devices of the drivers ina3221*, by the names of their folders below `inner`.
std::vector<path> driver_devices(const path& sysfs, const path& inner, std::string_view prefix) {
    std::vector<path> devices;
    for (const auto& driver : sysfs_entries(sysfs / "bus/i2c/drivers", "ina3221"))
        for (const auto& bound : sysfs_entries(driver))
            for (const auto& device : sysfs_entries(bound / inner, prefix)) add_device(devices, device);
    return devices;
}

/// A channel's label, or the device and the channel's number.
std::string channel_name(const path& label, int channel) {
    return sysfs_text(label).value_or(fmt::format("{}.{}", label.parent_path().filename().string(), channel));
}

std::vector<PowerRail> iio_rails(const path& sysfs) {
    auto devices = driver_devices(sysfs, "", "iio");
    for (const auto& device : sysfs_entries(sysfs / "bus/iio/devices", "iio:device")) {
        const auto name = sysfs_text(device / "name").value_or("");
        if (name.starts_with("ina3221") || sysfs_text(device / "rail_name_0")) add_device(devices, device);
    }
    std::vector<PowerRail> rails;
    for (const auto& device : devices)
        for (int i = 0; i < channels; ++i)
            add_rail(channel_name(device / fmt::format("rail_name_{}", i), i),
                     device / fmt::format("in_power{}_input", i), device / fmt::format("in_voltage{}_input", i),
                     device / fmt::format("in_current{}_input", i), rails);
    return rails;
}

std::vector<PowerRail> hwmon_rails(const path& sysfs) {
    auto devices = driver_devices(sysfs, "hwmon", "hwmon");
    for (const auto& device : sysfs_entries(sysfs / "class/hwmon", "hwmon"))
        if (sysfs_text(device / "name").value_or("").starts_with("ina3221")) add_device(devices, device);
    std::vector<PowerRail> rails;
    for (const auto& device : devices) {
        for (int i = 1; i <= channels; ++i) {
            if (sysfs_number(device / fmt::format("in{}_enable", i)) == 0.0) continue;
            add_rail(channel_name(device / fmt::format("in{}_label", i), i), {}, device / fmt::format("in{}_input", i),
                     device / fmt::format("curr{}_input", i), rails);
        }
    }
    return rails;
}

/// Indices of the rails whose sum is the power of the board: those `wanted`; else the total (VDD_IN, POM_5V_IN, ...);
/// else the processor's packages; else all that no other rail feeds. Throws NoResultError for a missing one.
std::vector<std::size_t> rails_of_total(const std::vector<std::string>& names, const std::vector<std::string>& wanted) {
    std::vector<std::size_t> chosen;
    for (const auto& name : wanted) {
        const auto found = std::ranges::find(names, name);
        if (found == names.end()) {
            throw NoResultError(fmt::format("there is no rail '{}'; there are {}", name, fmt::join(names, ", ")));
        }
        chosen.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    if (!chosen.empty()) return chosen;
    for (const auto total : total_rails) {
        const auto found = std::ranges::find(names, total);
        if (found != names.end()) return {static_cast<std::size_t>(found - names.begin())};
    }
    const bool has_packages = std::ranges::any_of(names, [](const auto& name) { return name.starts_with(package); });
    for (std::size_t i = 0; i < names.size(); ++i) {
        const bool is_derived = std::ranges::find(derived_rails, names[i]) != std::end(derived_rails);
        if (has_packages ? names[i].starts_with(package) : !is_derived) chosen.push_back(i);
    }
    return chosen;
}

/// TI INA3221 of NVIDIA's Jetsons, by NVIDIA's IIO driver (L4T up to 32; bus/i2c/drivers/ina3221x, bus/iio/devices:
/// rail_name_0, in_power0_input [mW], else in_voltage0_input [mV] times in_current0_input [mA]), else by the kernel's
/// hwmon driver (L4T from 34; Documentation/hwmon/ina3221: in1_label, in1_input [mV] times curr1_input [mA]; channels
/// with in1_enable 0 are skipped).
std::vector<PowerRail> ina3221_rails(const path& sysfs) {
    auto rails = iio_rails(sysfs);
    return rails.empty() ? hwmon_rails(sysfs) : rails;
}

/// Energy counters of Intel and AMD RAPL below class/powercap, intel-rapl:0 and below. They wrap at
/// max_energy_range_uj, and step about once a millisecond: over less than `shortest_s` there is no reading, and the next
/// one covers that time too.
std::vector<PowerRail> rapl_rails(const path& sysfs, double shortest_s) {
    std::vector<PowerRail> rails;
    // Not intel-rapl-mmio:0, which counts the package once more.
    for (const auto& zone : sysfs_entries(sysfs / "class/powercap", "intel-rapl:")) {
        const auto file = zone / "energy_uj";
        const auto range_uj = sysfs_number(zone / "max_energy_range_uj");
        if (!sysfs_number(file) || !range_uj) continue;
        auto mean_power_w = [file, shortest_s, range_uj = *range_uj, last_uj = 0.0,
                             last = std::optional<Clock::time_point>()](Clock::time_point now) mutable {
            const double time_s = last ? std::chrono::duration<double>(now - *last).count() : 0.0;
            if (last && time_s < shortest_s) return std::numeric_limits<double>::quiet_NaN();
            const double now_uj = require_sysfs_number(file);
            const double energy_uj = now_uj - last_uj + (now_uj < last_uj ? range_uj : 0.0);
            last_uj = now_uj;
            last = now;
            return time_s > 0.0 ? units::joule_from_microjoule(energy_uj) / time_s
                                : std::numeric_limits<double>::quiet_NaN();
        };
        const auto name = sysfs_text(zone / "name").value_or(zone.filename().string());
        rails.push_back({name, file.string(), std::move(mean_power_w)});
    }
    return rails;
}

struct Sensor {
    SamplerKind kind;
    std::vector<PowerRail> rails;
};

PowerSampler sampler_of(const Sensor& sensor, const std::vector<std::string>& wanted) {
    std::vector<PowerRail> chosen;
    std::vector<std::string> names;
    std::vector<std::string> sources;
    for (const auto& rail : sensor.rails) names.push_back(rail.name);
    for (const auto index : rails_of_total(names, wanted)) {
        chosen.push_back(sensor.rails[index]);
        sources.push_back(fmt::format("{} ({})", chosen.back().name, chosen.back().source));
    }
    PowerSampler sampler;
    sampler.kind = sensor.kind;
    sampler.source = fmt::format("{}", fmt::join(sources, " + "));
    sampler.read = [chosen]() -> std::vector<PowerReading> {
        const auto before = std::chrono::steady_clock::now();
        double power_w = 0.0;
        for (const auto& rail : chosen) power_w += rail.read(before);
        if (std::isnan(power_w)) return {};
        // The time stamp is the middle of the reading.
        return {{before + (std::chrono::steady_clock::now() - before) / 2, power_w}};
    };
    return sampler;
}

/// A pseudo terminal without echo and translations: programs that print through stdio flush each line into it, into a
/// pipe only each block. `ends`: ours, the program's. Returns false with errno without one.
bool open_terminal(int (&ends)[2]) {
    std::array<char, 128> name{};
    ends[0] = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (ends[0] < 0 || ::grantpt(ends[0]) != 0 || ::unlockpt(ends[0]) != 0 ||
        ::ptsname_r(ends[0], name.data(), name.size()) != 0)
        return false;
    ends[1] = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    ::termios settings{};
    if (ends[1] < 0 || ::tcgetattr(ends[1], &settings) != 0) return false;
    ::cfmakeraw(&settings);
    return ::tcsetattr(ends[1], TCSANOW, &settings) == 0 && ::fcntl(ends[0], F_SETFL, O_NONBLOCK) == 0;
}

class CommandSampler {
  public:
    explicit CommandSampler(const SamplerSettings& settings)
        : command_(settings.command), folder_(settings.folder), interval_s_(settings.interval_s) {
        start();
    }
    ~CommandSampler() { stop(); }
    CommandSampler(const CommandSampler&) = delete;
    CommandSampler& operator=(const CommandSampler&) = delete;

    int file() const { return output_; }

    std::vector<PowerReading> read() {
        std::vector<PowerReading> readings;
        take_output(readings);
        const auto ended = running_ ? running_->ended() : std::vector<FinishedCommand>();
        if (!ended.empty()) {
            take_output(readings);  // its last output
            require_success(ended.front());
            stop();
        }
        const double since_start_s = std::chrono::duration<double>(Clock::now() - started_).count();
        if (!running_ && since_start_s >= interval_s_) start();
        return readings;
    }

  private:
    std::string name() const { return fmt::format("{}", fmt::join(command_, " ")); }

    void start() {
        int ends[2] = {-1, -1};
        if (!open_terminal(ends)) {
            throw OutputError(fmt::format("cannot make a pseudo terminal: {}", std::strerror(errno)));
        }
        output_ = ends[0];
        started_ = Clock::now();
        lines_ = 0;
        pending_.clear();
        constexpr std::chrono::milliseconds patience(500);  // no cleanup to wait for
        running_.emplace(std::vector<std::vector<std::string>>{command_},
                         SupervisionOptions{ends[1], STDERR_FILENO, patience, folder_, false});
        ::close(ends[1]);
    }

    void stop() {
        running_.reset();
        if (output_ >= 0) ::close(output_);
        output_ = -1;
    }

    void require_success(const FinishedCommand& ended) const {
        if (ended.start_error == 0 && ended.wait_status == 0 && lines_ > 0) return;
        throw NoResultError(
            fmt::format("the sampler '{}' {}{}", name(), ended.start_error == 0 ? "ended: " : "", to_string(ended)) +
            (lines_ == 0 ? ", without a reading" : ""));
    }

    void take_output(std::vector<PowerReading>& readings) {
        if (output_ < 0) return;
        std::array<char, 4096> buffer;
        while (true) {
            const auto count = ::read(output_, buffer.data(), buffer.size());
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) return;
            pending_.append(buffer.data(), static_cast<std::size_t>(count));
            take_lines(readings);
            constexpr std::size_t max_line = 4096;
            if (pending_.size() <= max_line) continue;
            throw InputError({name(), lines_ + 1}, "the sampler prints no line ends, expected watts, a number a line");
        }
    }

    void take_lines(std::vector<PowerReading>& readings) {
        for (auto end = pending_.find('\n'); end != std::string::npos; end = pending_.find('\n')) {
            auto line = pending_.substr(0, end);
            pending_.erase(0, end + 1);
            line.erase(0, line.find_first_not_of(" \t"));
            line.erase(line.find_last_not_of(" \t\r") + 1);
            const auto power_w = parse_number(line);
            if (!power_w) {
                throw InputError({name(), lines_ + 1},
                                 fmt::format("the sampler printed '{}', expected watts, a number a line", line));
            }
            ++lines_;
            readings.push_back({Clock::now(), *power_w});
        }
    }

    std::vector<std::string> command_;
    std::filesystem::path folder_;
    double interval_s_;
    std::optional<SupervisedProcesses> running_;
    int output_ = -1;
    Clock::time_point started_;
    std::string pending_;    ///< an incomplete line
    std::size_t lines_ = 0;  ///< since the start
};

/// A program that prints watts, a number a line: one that keeps printing, each line stamped on arrival, or one that
/// prints and exits with 0, which is restarted for each reading. It ends with the sampler, with its children. Reading
/// throws InputError for a line that is not a number, NoResultError when the program fails or ends without a line.
PowerSampler open_command_sampler(const SamplerSettings& settings) {
    auto meter = std::make_shared<CommandSampler>(settings);
    PowerSampler sampler;
    sampler.kind = SamplerKind::command;
    sampler.source = fmt::format("{}", fmt::join(settings.command, " "));
    sampler.read = [meter] { return meter->read(); };
    sampler.file = [meter] { return meter->file(); };
    return sampler;
}

}  // namespace

std::string_view to_string(SamplerKind kind) { return kind_names[static_cast<std::size_t>(kind)]; }

SamplerSettings read_sampler_settings(const TomlTable& root, const std::filesystem::path& folder) {
    SamplerSettings settings;
    settings.folder = folder;
    settings.where = root.where();
    const auto given = root.optional_table("sampler");
    if (!given) return settings;
    const auto& table = *given;
    settings.where = table.where();
    settings.kind = kind_of(table);
    settings.interval_is_given = table.has("interval_s");
    settings.interval_s = number_in_or(more_than(0.0), table, "interval_s", settings.interval_s);
    if (table.has("rails")) settings.rails = table.strings("rails");
    if (const auto sysfs = table.optional_string("sysfs")) settings.sysfs = settings.folder / *sysfs;
    refuse_foreign_key(table, "command", settings.kind, SamplerKind::command);
    refuse_foreign_key(table, "file", settings.kind, SamplerKind::recorded);
    refuse_foreign_key(table, "idle_file", settings.kind, SamplerKind::recorded);
    if (settings.kind == SamplerKind::command) {
        settings.command = table.strings("command");
        if (settings.command.empty()) throw InputError(table.where("command"), "an empty command");
    }
    if (settings.kind == SamplerKind::recorded) settings.file = table.string("file");
    settings.idle_file = table.optional_string("idle_file").value_or("");
    table.refuse_unknown_keys();
    return settings;
}

PowerSampler open_sampler(const SamplerSettings& settings) {
    if (settings.kind == SamplerKind::command) return open_command_sampler(settings);
    const std::vector<Sensor> sensors{{SamplerKind::ina3221, ina3221_rails(settings.sysfs)},
                                      {SamplerKind::rapl, rapl_rails(settings.sysfs, settings.interval_s / 2.0)}};
    for (const auto& sensor : sensors) {
        const bool is_wanted = settings.kind == SamplerKind::automatic || settings.kind == sensor.kind;
        if (is_wanted && !sensor.rails.empty()) return sampler_of(sensor, settings.rails);
    }
    throw NoResultError(fmt::format(
        "there is no {} below {} that can be read; searched for INA3221 (bus/i2c/drivers/ina3221*, bus/iio, "
        "class/hwmon) and RAPL (class/powercap, often for root alone); a [sampler] of kind \"command\" reads any other "
        "meter",
        settings.kind == SamplerKind::automatic ? "power sensor"
                                                : fmt::format("sensor of kind {}", to_string(settings.kind)),
        settings.sysfs.string()));
}

}  // namespace flightwatt::compute
