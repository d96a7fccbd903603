#include "live/page_server.h"

#include "base/error.h"
#include "live/sources/endpoints.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <list>
#include <random>
#include <regex>
#include <thread>
#include <utility>
#include <vector>

#include <boost/algorithm/string/predicate.hpp>
#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/lexical_cast.hpp>
#include <fmt/format.h>

namespace flightwatt::live {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::algorithm::iequals;
using boost::system::error_code;

constexpr std::chrono::seconds max_request{10}, max_write{20};
constexpr std::size_t max_request_bytes = 16'384;
constexpr std::size_t max_unsent_bytes = 2'000'000;  // of a browser that has not read for minutes

constexpr int ok = 200, forbidden = 403, not_found = 404, not_allowed = 405, too_many = 503;

std::string_view text_of(boost::beast::string_view text) { return {text.data(), text.size()}; }

/// Whether a Host header is an address or localhost. Other names may resolve to this machine by DNS rebinding.
bool is_own_host(std::string_view host) {
    static const std::regex own(R"((localhost|[0-9.]+|\[[0-9a-f:.]+\])(:[0-9]+)?)", std::regex::icase);
    constexpr std::size_t max_length = 255;  // std::regex is recursive
    return host.size() <= max_length && std::regex_match(host.begin(), host.end(), own);
}

using Request = http::request<http::empty_body>;

std::string_view target_of(const Request& request) {
    return text_of(request.target().substr(0, request.target().find('?')));
}

int status_of(const Request& request) {
    const auto target = target_of(request);
    const auto host = text_of(request[http::field::host]);
    const auto origin = text_of(request[http::field::origin]);
    const auto fetch_site = text_of(request["Sec-Fetch-Site"]);
    if (!is_own_host(host)) return forbidden;
    if (!origin.empty() && !iequals(origin, "http://" + std::string(host))) return forbidden;
    if (request.method() != http::verb::get && request.method() != http::verb::head) return not_allowed;
    if (target == "/") return ok;  // also by a link on another page
    if (target != "/state" && target != "/events") return not_found;
    return fetch_site.empty() || fetch_site == "same-origin" || fetch_site == "none" ? ok : forbidden;
}

/// The page may load only its own content.
constexpr std::string_view common_headers =
    "Cache-Control: no-store\r\nConnection: close\r\nX-Content-Type-Options: nosniff\r\nX-Frame-Options: DENY\r\n"
    "Referrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n"
    "Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data:; connect-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'\r\n";

std::string head_of(int status, std::string_view type, std::string_view more) {
    return fmt::format("HTTP/1.1 {} {}\r\nContent-Type: {}\r\n{}{}\r\n", status,
                       text_of(http::obsolete_reason(static_cast<http::status>(status))), type, common_headers, more);
}

std::string response_of(const Request& request, int status, std::string_view type, std::string_view body) {
    const auto* more = status == not_allowed ? "Allow: GET, HEAD\r\n" : status == too_many ? "Retry-After: 30\r\n" : "";
    auto text = head_of(status, type, fmt::format("Content-Length: {}\r\n{}", body.size(), more));
    if (request.method() != http::verb::head) text += body;
    return text;
}

std::string_view error_text(int status) {
    if (status == forbidden) return "Use an address of this machine or localhost, and this server's own page.\n";
    if (status == not_allowed) return "Only GET and HEAD are supported.\n";
    if (status == too_many) return "The maximum number of pages is open.\n";
    return "Only /, /state and /events exist.\n";
}

std::string event_of(std::string_view name, std::string_view data) {
    return fmt::format("event: {}\ndata: {}\n\n", name, data);
}

tcp::endpoint parse_listening_address(std::string_view at) {
    if (const auto parsed = parse_address_and_port(at, "127.0.0.1")) return {parsed->address, parsed->port};
    throw UsageError(fmt::format("--serve {}: expected PORT or ADDRESS:PORT, as 8080 or 127.0.0.1:8080", at));
}

/// Throws InputError.
tcp::acceptor listen(asio::io_context& context, const tcp::endpoint& at) {
    try {
        tcp::acceptor acceptor(context, at);
        close_on_exec(acceptor);
        return acceptor;
    } catch (const boost::system::system_error& error) {
        throw InputError({fmt::format("--serve {}:{}", at.address().to_string(), at.port())},
                         fmt::format("cannot listen: {}", error.code().message()),
                         "find the program that uses the port (ss -ltp), or use another port");
    }
}

}  // namespace

/// A connection of a browser: one request and its response, which for a listener to events does not end.
struct PageServer::Session {
    explicit Session(tcp::socket socket)
        : stream(std::move(socket)), more(stream.get_executor(), asio::steady_timer::time_point::max()) {}

    void send(std::string_view text) {
        if (outgoing.size() > max_unsent_bytes) return;  // it is closed, and ends soon
        outgoing += text;
        if (outgoing.size() > max_unsent_bytes) stream.close();
        more.cancel();
    }

    boost::beast::tcp_stream stream;
    asio::steady_timer more;  ///< cancelled when there is more to send
    std::string outgoing;
    bool is_listener = false;
};

class PageServer::Server {
  public:
    Server(const tcp::endpoint& at, std::string page)
        : page_(std::move(page)), acceptor_(listen(context_, at)), endpoint_(acceptor_.local_endpoint()) {
        asio::co_spawn(context_,
                       accept_connections(acceptor_, [this](tcp::socket socket) { accept(std::move(socket)); }),
                       asio::detached);
        thread_ = start_without_signals([this] { context_.run(); });
    }
    ~Server() {
        context_.stop();
        thread_.join();
    }
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    tcp::endpoint endpoint() const { return endpoint_; }

    void publish(std::string state, std::string point) {
        asio::post(context_, [this, state = std::move(state), point = std::move(point)]() mutable {
            state_ = std::move(state);
            if (!point.empty()) points_.push_back(std::move(point));
            std::size_t index = 0;
            if (points_.size() > max_points) std::erase_if(points_, [&](const auto&) { return index++ % 2 == 1; });
            const auto event = event_of("state", state_);
            for (const auto& session : sessions_)
                if (session->is_listener) session->send(event);
        });
    }

  private:
    void accept(tcp::socket socket) {
        if (sessions_.size() >= 2 * max_connections) close_oldest_request();
        const auto session = sessions_.emplace_back(std::make_shared<Session>(std::move(socket)));
        asio::co_spawn(context_, serve(*session),
                       [this, session](const std::exception_ptr&) { sessions_.remove(session); });
    }

    /// Until the response is sent, or for a listener until the browser closes. Throws where the connection fails.
    asio::awaitable<void> serve(Session& session) {
        boost::beast::flat_buffer buffer;
        http::request_parser<http::empty_body> parser;
        parser.header_limit(max_request_bytes);
        parser.body_limit(max_request_bytes);
        session.stream.expires_after(max_request);
        co_await http::async_read_header(session.stream, buffer, parser, asio::use_awaitable);
        session.outgoing = respond(parser.get(), session);
        do {
            const auto text = std::exchange(session.outgoing, {});
            session.stream.expires_after(max_write);
            co_await asio::async_write(session.stream, asio::buffer(text), asio::use_awaitable);
            session.stream.expires_never();
            error_code cancelled;
            if (session.is_listener && session.outgoing.empty())
                co_await session.more.async_wait(asio::redirect_error(asio::use_awaitable, cancelled));
        } while (session.is_listener);
        session.stream.socket().shutdown(tcp::socket::shutdown_both);
    }

    /// The response to a request; a listener is registered.
    std::string respond(const Request& request, Session& session) const {
        constexpr auto plain = "text/plain; charset=utf-8";
        const auto target = target_of(request);
        const int status = status_of(request);
        if (status != ok) return response_of(request, status, plain, error_text(status));
        if (target == "/") return response_of(request, status, "text/html; charset=utf-8", page_);
        if (target == "/state") return response_of(request, status, "application/json", state_ + "\n");
        if (request.method() == http::verb::head) return head_of(status, "text/event-stream", "");
        if (listeners() >= max_connections) return response_of(request, too_many, plain, error_text(too_many));
        session.is_listener = true;
        return head_of(status, "text/event-stream", "") + first_events();
    }

    /// Identifies this run of the program to pages that reconnect, with all points so far and the state.
    std::string first_events() const {
        return "retry: 1000\n\n" +
               event_of("begin", fmt::format(R"({{"run":"{}","points":[{}]}})", run_, fmt::join(points_, ","))) +
               event_of("state", state_);
    }

    std::size_t listeners() const {
        return static_cast<std::size_t>(
            std::ranges::count_if(sessions_, [](const auto& session) { return session->is_listener; }));
    }

    /// Oldest connection that is not a listener: it was answered, or has sent no request.
    void close_oldest_request() {
        const auto oldest = std::ranges::find_if(sessions_, [](const auto& session) { return !session->is_listener; });
        if (oldest != sessions_.end()) (*oldest)->stream.close();
    }

    const std::string page_;
    std::string state_ = "null";
    asio::io_context context_;
    tcp::acceptor acceptor_;
    tcp::endpoint endpoint_;
    std::vector<std::string> points_;
    std::list<std::shared_ptr<Session>> sessions_;
    const std::string run_ = fmt::format("{:08x}{:08x}", std::random_device()(), std::random_device()());
    std::thread thread_;
};

PageServer::PageServer(std::string_view at, std::string page)
    : server_(std::make_unique<Server>(parse_listening_address(at), std::move(page))) {}

PageServer::~PageServer() = default;

std::string PageServer::address() const {
    auto at = server_->endpoint();
    if (at.address().is_unspecified()) at.address(asio::ip::address_v4::loopback());
    return "http://" + boost::lexical_cast<std::string>(at) + "/";
}

bool PageServer::is_local() const { return server_->endpoint().address().is_loopback(); }

void PageServer::publish(std::string state, std::string point) { server_->publish(std::move(state), std::move(point)); }

}  // namespace flightwatt::live
