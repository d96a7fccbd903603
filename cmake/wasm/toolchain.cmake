# Debian's clang 19 for WebAssembly with WASI, which a page or node runs: scripts/build_wasm. Runtime and libraries are in
# a sysroot beside the build (cmake/wasm/libraries); what this C library lacks is in cmake/wasm/include.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_C_COMPILER clang-19)
set(CMAKE_CXX_COMPILER clang++-19)
set(CMAKE_AR llvm-ar-19 CACHE FILEPATH "")
set(CMAKE_RANLIB llvm-ranlib-19 CACHE FILEPATH "")
set(CMAKE_C_COMPILER_TARGET wasm32-wasi)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_EXECUTABLE_SUFFIX .wasm)
set(CMAKE_EXECUTABLE_SUFFIX_CXX .wasm)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)  # the runtime may not be there yet
get_filename_component(wasm_sysroot ${CMAKE_CURRENT_LIST_DIR}/../../build/wasm/sysroot ABSOLUTE)
set(CMAKE_FIND_ROOT_PATH ${wasm_sysroot})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_HAVE_LIBC_PTHREAD TRUE)  # of cmake/wasm/include: one thread

# No header of this machine's: clang would search /usr/include. Debian's libc++ for this target has headers and, in its
# library, neither exceptions nor files nor threads: the library is built of the sources, and the headers are set so.
set(c_headers "-nostdinc -isystem ${CMAKE_CURRENT_LIST_DIR}/include -isystem /usr/lib/llvm-19/lib/clang/19/include -isystem /usr/include/wasm32-wasi")
set(cxx_headers "-nostdinc++ -isystem ${wasm_sysroot}/include/c++ -isystem /usr/lib/llvm-19/include/wasm32-wasi/c++/v1 -isystem ${wasm_sysroot}/include")
set(emulated "-D_WASI_EMULATED_SIGNAL -D_WASI_EMULATED_MMAN -D_WASI_EMULATED_PROCESS_CLOCKS -D_WASI_EMULATED_GETPID")
# Its warnings are not GCC's, which every build of the program shows. Boost 1.74 needs what C++17 removed.
set(CMAKE_C_FLAGS_INIT "-w -include posix_missing.h ${c_headers} ${emulated}")
set(CMAKE_CXX_FLAGS_INIT "-w -Wno-enum-constexpr-conversion -fwasm-exceptions -fexperimental-library \
-D_LIBCPP_ENABLE_CXX17_REMOVED_UNARY_BINARY_FUNCTION -include posix_missing.h ${cxx_headers} ${c_headers} ${emulated}")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-nostdlib++ -fuse-ld=lld -L${wasm_sysroot}/lib -Wl,-z,stack-size=8388608 -Wl,--gc-sections -Wl,--strip-all")
set(CMAKE_CXX_STANDARD_LIBRARIES "-lz -lruntime -lwasi-emulated-signal -lwasi-emulated-mman -lwasi-emulated-getpid -lwasi-emulated-process-clocks")
