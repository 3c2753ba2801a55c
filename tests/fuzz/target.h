/* A fuzz target: one function, told bytes, that must come back whatever they are.
 *
 * With PSCN_FUZZ each target is linked with libFuzzer (clang), which makes the bytes up; else with replay.c, which reads
 * them from the files it is given. A crash is a crash, a failed assert included; what takes too long is ended by either.
 */
#ifndef PSCN_TESTS_FUZZ_TARGET_H
#define PSCN_TESTS_FUZZ_TARGET_H

#undef NDEBUG
#include <assert.h>
#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#endif
