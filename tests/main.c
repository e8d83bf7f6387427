/* Runs the CUnit suites: all of them, or those whose names contain the first argument. Exit code 1: a test failed. */
#include "tests/suites.h"

#include <CUnit/Basic.h>
#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    int (*add)(void);
} suites[] = {
#define SUITE(area) {#area, suite_##area},
#include "tests/suites.h"
};

int main(int argc, char **argv) {
    const char *wanted = argc > 1 ? argv[1] : "";
    unsigned added = 0;
    if (CU_initialize_registry() != CUE_SUCCESS) return 1;
    for (size_t i = 0; i < sizeof suites / sizeof *suites; i++) {
        if (strstr(suites[i].name, wanted) == NULL) continue;
        if (suites[i].add() != 0) {
            fprintf(stderr, "tests/run: the suite %s could not be added: %s\n", suites[i].name, CU_get_error_msg());
            return 1;
        }
        added++;
    }
    if (added == 0) {
        fprintf(stderr, "tests/run: no suite is called '%s'\n", wanted);
        return 1;
    }
    CU_basic_set_mode(CU_BRM_VERBOSE);
    CU_basic_run_tests();
    unsigned failures = CU_get_number_of_failures() + CU_get_number_of_suites_failed();
    CU_cleanup_registry();
    return failures == 0 ? 0 : 1;
}
