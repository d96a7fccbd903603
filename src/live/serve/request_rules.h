#pragma once

#include <string_view>

namespace flightwatt::live {

/// What a request says of who asks.
struct RequestHead {
    std::string_view method;
    std::string_view target;
    std::string_view host;             ///< Host
    std::string_view origin = {};      ///< Origin; empty without
    std::string_view fetch_site = {};  ///< Sec-Fetch-Site; empty without
};

/// How a request is answered: 200, 403, 404 or 405.
int status_of(const RequestHead& request);

/// Whether a Host header names this machine by an address, or as localhost: a name that some name server made an
/// address of this machine's is neither.
bool is_own_host(std::string_view host);

}  // namespace flightwatt::live
