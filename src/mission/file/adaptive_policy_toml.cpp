#include "mission/file/adaptive_policy_toml.h"

#include "base/toml_numbers.h"

#include <fmt/format.h>

namespace flightwatt::mission {

std::optional<AdaptivePolicy> read_adaptive_policy(const TomlTable& mission) {
    const auto policy = mission.optional_table("policy");
    if (!policy) return std::nullopt;
    policy->refuse_keys_except(
        {"kind", "decide_every_s", "mechanical_sd_percent", "learning_time_s", "probability"});
    const auto kind = policy->string("kind");
    if (kind == "static") {
        for (const auto& key : policy->keys()) {
            if (key == "kind") continue;
            throw InputError(policy->where(key),
                             fmt::format("`{}` has no meaning with kind = \"static\"", key),
                             "leave it out, or make it kind = \"adaptive\"");
        }
        return std::nullopt;
    }
    if (kind != "adaptive") {
        throw InputError(policy->where("kind"), fmt::format("there is no policy '{}'", kind),
                         "it is \"adaptive\" or \"static\"");
    }
    AdaptivePolicy read;
    read.decide_every_s = number_in_or(between(0.1, 1e6), *policy, "decide_every_s", 0.0);
    read.mechanical_sd_percent =
        number_in_or(between(0.0, 100.0), *policy, "mechanical_sd_percent", read.mechanical_sd_percent);
    read.learning_time_s = number_in_or(between(0.0, 1e6), *policy, "learning_time_s", read.learning_time_s);
    read.probability = number_in_or(between(0.5, 0.999999), *policy, "probability", read.probability);
    return read;
}

}  // namespace flightwatt::mission
