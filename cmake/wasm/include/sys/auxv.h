/* There is no auxiliary vector. */
#pragma once

#define AT_EXECFN 31

static inline unsigned long getauxval(unsigned long type) {
    (void)type;
    return 0;
}
