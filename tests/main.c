/* The main of programs that have none of their own. */
#include "cmocka_test.h"

int main(void) { return test_run(); }
