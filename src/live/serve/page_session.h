#pragma once

#include "live/serve/request_rules.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>

namespace flightwatt::live {

/// What sessions answer with.
struct PageContents {
    std::string page;
    std::string state = "null";
    std::function<std::string()> first_events;  ///< what a listener is told before what is new
    std::function<bool()> has_room;             ///< for one more listener
};

/// A connection of a browser: one request, one answer, which for a listener does not end.
class PageSession : public std::enable_shared_from_this<PageSession> {
  public:
    /// `on_end` is called once.
    PageSession(boost::asio::ip::tcp::socket socket, const PageContents& contents,
                std::function<void(const PageSession&)> on_end);

    void start();
    bool is_listener() const { return is_listener_; }
    void send(std::string_view text);
    void close();

  private:
    void answer();
    void write_next();
    void watch_for_end();

    boost::beast::tcp_stream stream_;
    const PageContents& contents_;
    std::function<void(const PageSession&)> on_end_;
    boost::beast::flat_buffer buffer_;
    std::optional<boost::beast::http::request_parser<boost::beast::http::empty_body>> parser_;
    std::string outgoing_, writing_;
    char beyond_ = '\0';
    bool is_listener_ = false, closed_ = false;
};

}  // namespace flightwatt::live
