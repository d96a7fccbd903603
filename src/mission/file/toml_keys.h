#pragma once

#include <string>
#include <vector>

namespace flightwatt::mission {

/// A key as people write it: quoted only if it has to be.
std::string toml_key(const std::string& name);

/// "{ a = 1, b = 2 }" of "a = 1" and "b = 2"; "{}" of none.
std::string toml_inline_table(const std::vector<std::string>& pairs);

}  // namespace flightwatt::mission
