// What the static program has in place of functions that its libraries refer to.
#include <cstdio>
#include <cstdlib>

#include <nss.h>

namespace {

// Names of hosts and users by files and DNS, which are in glibc. Other services of /etc/nsswitch.conf are libraries of
// the system, for which this glibc may be too old or too new. First of all: glog asks for the user before main.
[[gnu::constructor(101)]] void use_own_name_services() {
    __nss_configure_lookup("hosts", "files dns");
    __nss_configure_lookup("passwd", "files");
}

}  // namespace

#define FLIGHTWATT_NOT_LINKED(name)                                                 \
    extern "C" [[noreturn]] void name();                                            \
    void name() {                                                                   \
        std::fputs("flightwatt: " #name " is not in the static program\n", stderr); \
        std::abort();                                                               \
    }

// Ceres has solvers of sparse systems (by CHOLMOD, under the GPL, and CXSparse) and by LAPACK. The fits of FlightWatt
// are by ceres::DENSE_QR, which calls none of these.
FLIGHTWATT_NOT_LINKED(cholmod_amd)
FLIGHTWATT_NOT_LINKED(cholmod_analyze)
FLIGHTWATT_NOT_LINKED(cholmod_analyze_p)
FLIGHTWATT_NOT_LINKED(cholmod_camd)
FLIGHTWATT_NOT_LINKED(cholmod_factorize)
FLIGHTWATT_NOT_LINKED(cholmod_finish)
FLIGHTWATT_NOT_LINKED(cholmod_free_dense)
FLIGHTWATT_NOT_LINKED(cholmod_free_factor)
FLIGHTWATT_NOT_LINKED(cholmod_free_sparse)
FLIGHTWATT_NOT_LINKED(cholmod_print_common)
FLIGHTWATT_NOT_LINKED(cholmod_solve)
FLIGHTWATT_NOT_LINKED(cholmod_start)
FLIGHTWATT_NOT_LINKED(cholmod_triplet_to_sparse)
FLIGHTWATT_NOT_LINKED(cholmod_zeros)
FLIGHTWATT_NOT_LINKED(dgeqrf_)
FLIGHTWATT_NOT_LINKED(dormqr_)
FLIGHTWATT_NOT_LINKED(dpotrf_)
FLIGHTWATT_NOT_LINKED(dpotrs_)
FLIGHTWATT_NOT_LINKED(dtrtrs_)
FLIGHTWATT_NOT_LINKED(cs_di_amd)
FLIGHTWATT_NOT_LINKED(cs_di_calloc)
FLIGHTWATT_NOT_LINKED(cs_di_chol)
FLIGHTWATT_NOT_LINKED(cs_di_cholsol)
FLIGHTWATT_NOT_LINKED(cs_di_compress)
FLIGHTWATT_NOT_LINKED(cs_di_counts)
FLIGHTWATT_NOT_LINKED(cs_di_cumsum)
FLIGHTWATT_NOT_LINKED(cs_di_etree)
FLIGHTWATT_NOT_LINKED(cs_di_free)
FLIGHTWATT_NOT_LINKED(cs_di_ipvec)
FLIGHTWATT_NOT_LINKED(cs_di_lsolve)
FLIGHTWATT_NOT_LINKED(cs_di_ltsolve)
FLIGHTWATT_NOT_LINKED(cs_di_malloc)
FLIGHTWATT_NOT_LINKED(cs_di_multiply)
FLIGHTWATT_NOT_LINKED(cs_di_nfree)
FLIGHTWATT_NOT_LINKED(cs_di_pinv)
FLIGHTWATT_NOT_LINKED(cs_di_post)
FLIGHTWATT_NOT_LINKED(cs_di_pvec)
FLIGHTWATT_NOT_LINKED(cs_di_schol)
FLIGHTWATT_NOT_LINKED(cs_di_sfree)
FLIGHTWATT_NOT_LINKED(cs_di_spfree)
FLIGHTWATT_NOT_LINKED(cs_di_symperm)
FLIGHTWATT_NOT_LINKED(cs_di_transpose)

// glog prints the stack where one of its checks ends the program, by libunwind, which defines what the unwinding of
// exceptions defines. Here the stack has no entries.
extern "C" int _Ux86_64_getcontext(void*);
extern "C" int _ULx86_64_init_local(void*, void*);
extern "C" int _ULx86_64_get_reg(void*, int, void*);
int _Ux86_64_getcontext(void*) { return 0; }
int _ULx86_64_init_local(void*, void*) { return 0; }
int _ULx86_64_get_reg(void*, int, void*) { return -1; }
FLIGHTWATT_NOT_LINKED(_ULx86_64_step)
