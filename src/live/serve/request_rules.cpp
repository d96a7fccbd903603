#include "live/serve/request_rules.h"

#include "base/number.h"

#include <algorithm>
#include <cctype>
#include <string>

#include <boost/asio/ip/address.hpp>

namespace flightwatt::live {
namespace {

std::string lower_case(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower;
}

/// Without its port; empty where that is none.
std::string_view without_port(std::string_view host) {
    const auto end = host.starts_with('[') ? host.find(']') : std::string_view::npos;
    const auto colon = host.find(':', end == std::string_view::npos ? 0 : end);
    if (colon == std::string_view::npos) return host;
    return parse_unsigned(host.substr(colon + 1)) ? host.substr(0, colon) : std::string_view();
}

}  // namespace

bool is_own_host(std::string_view host) {
    auto name = without_port(host);
    if (lower_case(name) == "localhost") return true;
    if (name.starts_with('[') && name.ends_with(']')) name = name.substr(1, name.size() - 2);
    boost::system::error_code error;
    boost::asio::ip::make_address(std::string(name), error);
    return !error;
}

int status_of(const RequestHead& request) {
    constexpr int ok = 200, forbidden = 403, not_found = 404, not_allowed = 405;
    if (!is_own_host(request.host)) return forbidden;
    if (!request.origin.empty() && lower_case(request.origin) != "http://" + lower_case(request.host)) return forbidden;
    if (request.method != "GET" && request.method != "HEAD") return not_allowed;
    if (request.target == "/") return ok;  // also by a link on another page
    if (request.target != "/state" && request.target != "/events") return not_found;
    const bool is_own =
        request.fetch_site.empty() || request.fetch_site == "same-origin" || request.fetch_site == "none";
    return is_own ? ok : forbidden;
}

}  // namespace flightwatt::live
