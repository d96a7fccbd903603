#include "compute/powprofiler/powprofiler_config.h"
#include "compute/profile_specification.h"
#include "compute/qos_range.h"

#include <algorithm>
#include <iterator>
#include <sstream>

#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

/// powprofiler hands the words, joined by blanks, to a shell. Where none of them needs one they are run
/// directly, so that a program that is missing is told from one that fails.
std::vector<std::string> shell_words(const std::string& line) {
    const auto is_plain = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
               std::string_view(" _./,:+@%=-").find(c) != std::string_view::npos;
    };
    if (!std::ranges::all_of(line, is_plain)) return {"/bin/sh", "-c", line};
    std::istringstream words(line);
    return {std::istream_iterator<std::string>(words), {}};
}

/// The command line at a combination of the ranges.
std::string line_of(const PowprofilerComponent& component, const std::vector<double>& qos) {
    std::string line = component.source;
    std::size_t next = 0;
    for (const auto& argument : component.arguments) {
        line += argument.fixed.empty() ? fmt::format(" {}", qos[next++]) : " " + argument.fixed;
    }
    return line;
}

ProfiledComponent profiled(const PowprofilerComponent& written) {
    ProfiledComponent component{written.name, {}, {}, {}};
    component.timing.duration_s = written.runtime_s;
    std::vector<QosRange> ranges;
    double count = 1.0;
    for (const auto& argument : written.arguments) {
        if (!argument.fixed.empty()) continue;
        count *= static_cast<double>(argument.values.size());
        component.parameters.push_back(fmt::format("qos_{}", ranges.size() + 1));
        ranges.push_back({component.parameters.back(), argument.values});
    }
    if (count > static_cast<double>(max_configurations)) {
        throw InputError(written.where, fmt::format("{} has {} configurations", written.name, count),
                         "profile fewer values");
    }
    for (const auto& qos : cartesian_product(ranges)) {
        component.configurations.push_back({qos, {shell_words(line_of(written, qos))}, {}});
    }
    return component;
}

ProfiledComponent profiled_combinations(const PowprofilerConfig& config, const std::filesystem::path& path) {
    auto name = std::filesystem::path(config.combinations_name).stem().string();
    if (name.empty()) name = path.stem().string();
    require_recordings(config, path);
    ProfiledComponent component{name, {}, {}, {}};
    for (std::size_t i = 1; i <= config.combinations.front().qos.size(); ++i) {
        component.parameters.push_back(fmt::format("qos_{}", i));
    }
    for (const auto& combination : config.combinations) {
        component.configurations.push_back({combination.qos, {}, combination.recording});
    }
    return component;
}

}  // namespace

ProfileSpecification read_powprofiler_specification(const std::filesystem::path& path) {
    const auto config = read_powprofiler_config(path);
    ProfileSpecification specification;
    specification.file = path.string();
    specification.sampler.folder = path.parent_path();
    specification.sampler.where = {path.string()};
    specification.sampler.interval_s = 1.0 / config.sampling_hz;
    specification.sampler.interval_is_given = true;
    if (!config.combinations.empty()) {
        if (!config.components.empty()) {
            throw InputError(config.components.front().where, "the file has [combinations] and components to run",
                             "keep them in two files");
        }
        specification.sampler.kind = SamplerKind::recorded;
        specification.idle_s = 0.0;
        specification.components.push_back(profiled_combinations(config, path));
        return specification;
    }
    for (const auto& component : config.components) {
        const auto& others = specification.components;
        if (std::ranges::find(others, component.name, &ProfiledComponent::name) != others.end()) {
            throw InputError(component.where, fmt::format("a second component '{}'", component.name));
        }
        specification.components.push_back(profiled(component));
    }
    if (specification.components.empty()) {
        throw InputError({path.string()}, "has neither [component.NAME] nor [combinations]");
    }
    return specification;
}

}  // namespace flightwatt::compute
