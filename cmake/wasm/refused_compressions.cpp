// Boost's bzip2, xz and zstd for the browser, which refuse: a page unpacks gzip alone.
#include <stdexcept>
#include <string>

#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <zstd.h>

// A frame is taken for a whole one: its decompressor refuses it.
std::size_t ZSTD_findFrameCompressedSize(const void*, std::size_t size) { return size; }
unsigned ZSTD_isError(std::size_t) { return 0; }

namespace boost::iostreams {
namespace {

[[noreturn]] void refuse(const std::string& compression) {
    throw std::runtime_error(compression + " cannot be unpacked in a browser; unpack the file first, or use gzip");
}

}  // namespace

namespace bzip2 {
const int ok = 0;
const int run = 0;
const int stream_end = 4;
}  // namespace bzip2

namespace lzma {
const std::uint32_t default_compression = 6;
const int okay = 0;
const int stream_end = 1;
const int finish = 3;
const int full_flush = 2;
const int run = 0;
}  // namespace lzma

namespace zstd {
const std::uint32_t default_compression = 3;
const int okay = 0;
const int stream_end = 1;
const int finish = 1;
const int flush = 2;
const int run = 0;
}  // namespace zstd

namespace detail {

bzip2_base::bzip2_base(const bzip2_params& params) : params_(params), stream_(nullptr), ready_(false) {
    refuse("bzip2");
}
bzip2_base::~bzip2_base() = default;
void bzip2_base::before(const char*&, const char*, char*&, char*) {}
void bzip2_base::after(const char*&, char*&) {}
int bzip2_base::compress(int) { refuse("bzip2"); }
int bzip2_base::decompress() { refuse("bzip2"); }
int bzip2_base::check_end(const char*, const char*) { refuse("bzip2"); }
int bzip2_base::end(bool, std::nothrow_t) { return 0; }
void bzip2_base::end(bool) {}
void bzip2_base::do_init(bool, bzip2::alloc_func, bzip2::free_func, void*) {}

lzma_base::lzma_base() { refuse("xz"); }
lzma_base::~lzma_base() = default;
void lzma_base::before(const char*&, const char*, char*&, char*) {}
void lzma_base::after(const char*&, char*&, bool) {}
int lzma_base::deflate(int) { refuse("xz"); }
int lzma_base::inflate(int) { refuse("xz"); }
void lzma_base::reset(bool, bool) {}
void lzma_base::do_init(const lzma_params&, bool, lzma::alloc_func, lzma::free_func, void*) {}

zstd_base::zstd_base() { refuse("zstd"); }
zstd_base::~zstd_base() = default;
void zstd_base::before(const char*&, const char*, char*&, char*) {}
void zstd_base::after(const char*&, char*&, bool) {}
int zstd_base::deflate(int) { refuse("zstd"); }
int zstd_base::inflate(int) { refuse("zstd"); }
void zstd_base::reset(bool, bool) {}
void zstd_base::do_init(const zstd_params&, bool, zstd::alloc_func, zstd::free_func, void*) {}

}  // namespace detail

bzip2_error::bzip2_error(int error) : failure("bzip2"), error_(error) {}
void bzip2_error::check BOOST_PREVENT_MACRO_SUBSTITUTION(int) {}
lzma_error::lzma_error(int error) : failure("xz"), error_(error) {}
void lzma_error::check BOOST_PREVENT_MACRO_SUBSTITUTION(int) {}
zstd_error::zstd_error(std::size_t error) : failure("zstd"), error_(error) {}
void zstd_error::check BOOST_PREVENT_MACRO_SUBSTITUTION(std::size_t) {}

}  // namespace boost::iostreams
