/* The list of methods: options in every form, and every method on tiles of every kind. */
#include "src/methods.h"
#include "tests/method_maker.h"

#include <CUnit/CUnit.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static struct method_choice chosen(const char *name, const char *assignment) {
    struct method_choice choice;
    struct scree_error error = {0};
    CU_ASSERT_EQUAL_FATAL(method_choose(name, &choice, &error), SCREE_OK);
    if (assignment != NULL) CU_ASSERT_EQUAL(method_set(&choice, assignment, &error), SCREE_OK);
    CU_ASSERT_STRING_EQUAL(error.text, "");
    return choice;
}

/* The first option of greedy, g_e, at a zoom whose tolerance is 3 m. */
static double g_e(const char *assignment, int zoom) {
    double values[METHOD_MAX_OPTIONS];
    struct method_choice choice = chosen("greedy", assignment);
    struct scree_error error = {0};
    return method_values_at(&choice, zoom, 3, values, &error) == SCREE_OK ? values[0] : -1;
}

static void options_have_a_value_at_every_zoom(void) {
    CU_ASSERT_EQUAL(g_e(NULL, 5), 3);
    CU_ASSERT_EQUAL(g_e("g_e=50", 0), 50);
    CU_ASSERT_EQUAL(g_e("g_e=50", 22), 50);
    CU_ASSERT_EQUAL(g_e("g_e=0.5e1", 22), 5);
    CU_ASSERT_EQUAL(g_e("g_e=0:50,5:20", 0), 50);
    CU_ASSERT_EQUAL(g_e("g_e=0:50,5:20", 4), 50);
    CU_ASSERT_EQUAL(g_e("g_e=0:50,5:20", 5), 20);
    CU_ASSERT_EQUAL(g_e("g_e=0:50,5:20", 22), 20);
    CU_ASSERT_EQUAL(g_e("g_e=2:7", 2), 7);
    CU_ASSERT_EQUAL(g_e("g_e=2:7", 1), -1);
    CU_ASSERT_EQUAL(g_e("g_e=15000/2", 0), 15000);
    CU_ASSERT_EQUAL(g_e("g_e=15000/2", 10), 15000.0 / 1024);
    CU_ASSERT_EQUAL(g_e("g_e=4*2", 3), 32);
    CU_ASSERT_EQUAL(g_e("g_e=9e6*2", 1), -1); /* out of its range there */
    double values[METHOD_MAX_OPTIONS];
    struct method_choice choice = chosen("greedy", "g_g=10/2");
    CU_ASSERT_EQUAL(method_set(&choice, "g_e=7", NULL), SCREE_OK);
    CU_ASSERT_EQUAL(method_set(&choice, "g_e=8", NULL), SCREE_OK); /* the last one counts */
    CU_ASSERT_EQUAL(method_values_at(&choice, 2, 3, values, NULL), SCREE_OK);
    CU_ASSERT_EQUAL(values[0], 8);
    CU_ASSERT_EQUAL(values[1], 3); /* 2.5, as a whole number */
}

static void wrong_options_are_told_by_name(void) {
    static const struct {
        const char *assignment, *word;
    } wrong[] = {{"g_e", "NAME=VALUE"},
                 {"g_e=", "g_e of method greedy"},
                 {"g_e=x", "0 to 1e+07"},
                 {"g_e=1x", "is no value"},
                 {"g_e=1/3", "is no value"},
                 {"g_e=1*3", "is no value"},
                 {"g_e=1:", "is no value"},
                 {"g_e=1:2,", "is no value"},
                 {"g_e=1:2,1:3", "is no value"},
                 {"g_e=23:1", "is no value"},
                 {"g_e=-1:1", "is no value"},
                 {"g_e=1:2/2", "is no value"},
                 {"g_e=nan", "is no value"},
                 {"g_e=inf", "is no value"},
                 {"g_e=-1", "-1 at zoom 0"},
                 {"g_e=0:1,3:-1", "at zoom 3"},
                 {"=1", "no option"},
                 {"g_ee=1", "no option g_ee"},
                 {"g=1", "no option g"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct method_choice choice = chosen("greedy", NULL);
        struct scree_error error = {0};
        CU_ASSERT_EQUAL(method_set(&choice, wrong[i].assignment, &error), SCREE_E_ARGUMENT);
        CU_ASSERT_PTR_NOT_NULL(strstr(error.text, wrong[i].word));
    }
    struct method_choice choice;
    struct scree_error error = {0};
    CU_ASSERT_EQUAL(method_choose("greed", &choice, &error), SCREE_E_ARGUMENT);
    CU_ASSERT_PTR_NOT_NULL(strstr(error.text, "there are: greedy, "));
    CU_ASSERT_PTR_NULL(choice.method);
    choice = chosen("qem", "bound=0");
    double values[METHOD_MAX_OPTIONS];
    struct scree_error other = {0};
    CU_ASSERT_EQUAL(method_values_at(&choice, 4, 3, values, &other), SCREE_E_ARGUMENT);
    CU_ASSERT_PTR_NOT_NULL(strstr(other.text, "method qem at zoom 4: "));
}

static void the_table_is_in_order(void) {
    int count = 0;
    for (const struct method *method = method_table; method->name != NULL; method++, count++) {
        CU_ASSERT_TRUE(method->option_count <= METHOD_MAX_OPTIONS);
        for (const struct method *other = method_table; other < method; other++)
            CU_ASSERT_STRING_NOT_EQUAL(other->name, method->name);
        for (int i = 0; i < method->option_count; i++) {
            const struct method_option *option = &method->options[i];
            CU_ASSERT_TRUE(option->least < option->most);
            CU_ASSERT_TRUE(isnan(option->standard) ||
                           (option->standard >= option->least && option->standard <= option->most));
            CU_ASSERT_TRUE(strlen(option->what) > 0 && strchr(option->what, '\n') == NULL);
            for (int k = 0; k < i; k++) CU_ASSERT_STRING_NOT_EQUAL(method->options[k].name, option->name);
        }
    }
    CU_ASSERT_TRUE(count >= 2);
}

/* Without options and at any zoom: the borders to the letter, a triangulation, the same twice. */
static void check_method(const char *name, const struct method_recipe *recipe) {
    struct made_method_tile *made = made_method_tile_new(recipe);
    struct method_choice choice = chosen(name, NULL);
    struct scree_memory memory = {0};
    struct method_mesh mesh = {0}, again = {0};
    struct scree_error error = {0};
    enum scree_status status = method_run(&choice, 7, 20, &memory, &made->tile, &mesh, &error);
    CU_ASSERT_EQUAL(status, SCREE_OK);
    if (status != SCREE_OK) printf("\n    %s: %s", name, error.text);
    struct method_verdict verdict = method_judge(&made->tile, &mesh);
    CU_ASSERT_TRUE(verdict.is_triangulation);
    if (!verdict.is_triangulation)
        printf("\n    %s on %d x %d cells of %d steps: %s", name, recipe->columns, recipe->rows, recipe->cell_span,
               verdict.fault);
    CU_ASSERT_EQUAL(method_run(&choice, 7, 20, &memory, &made->tile, &again, NULL), SCREE_OK);
    CU_ASSERT_TRUE(method_meshes_equal(&mesh, &again));
    method_mesh_release(&memory, &again);
    method_mesh_release(&memory, &mesh);
    CU_ASSERT_EQUAL(memory.used_bytes, 0);
    made_method_tile_free(made);
}

static void every_method_triangulates_every_tile(void) {
    static const struct method_recipe recipes[] = {
        {.columns = 48, .rows = 40, .cell_span = 1, .border_tolerance_m = 14},
        {.columns = 40, .rows = 48, .cell_span = 64, .border_tolerance_m = 5, .metres_a_step = 1, .is_round = true},
        {.columns = 1, .rows = 1, .cell_span = 2, .border_tolerance_m = 1},
        {.columns = 1, .rows = 20, .cell_span = 16, .border_tolerance_m = 1, .metres_a_step = 2},
        {.columns = 3, .rows = 2, .cell_span = 1, .border_tolerance_m = 0}};
    for (const struct method *method = method_table; method->name != NULL; method++)
        for (size_t i = 0; i < sizeof recipes / sizeof *recipes; i++) check_method(method->name, &recipes[i]);
}

static void a_bad_tile_reaches_no_method(void) {
    struct made_method_tile *made = made_method_tile_new(&(struct method_recipe){.columns = 8, .rows = 8});
    for (const struct method *method = method_table; method->name != NULL; method++)
        for (int fault = 0; fault < 5; fault++) {
            struct method_choice choice = chosen(method->name, NULL);
            struct method_tile tile = made->tile;
            struct border_line line = made->lines[SIDE_EAST];
            struct scree_memory memory = {0};
            struct scree_error error = {0};
            struct method_mesh mesh = {0};
            float heights_m[81];
            memcpy(heights_m, made->heights_m, sizeof heights_m);
            tile.heights_m = heights_m;
            tile.lines[SIDE_EAST] = &line;
            if (fault == 0) tile.columns = 0;
            if (fault == 1) heights_m[40] = (float)NAN;
            if (fault == 2) line.vertices[line.vertex_count - 1].position--;
            if (fault == 3) line.vertices[0].height_m += 1;
            if (fault == 4) line.vertices[1].position = 0;
            CU_ASSERT_EQUAL(method_run(&choice, 3, 20, &memory, &tile, &mesh, &error), SCREE_E_ARGUMENT);
            CU_ASSERT_PTR_NULL(mesh.vertices);
            CU_ASSERT_EQUAL(memory.used_bytes, 0);
        }
    made_method_tile_free(made);
}

int suite_methods(void) {
    CU_pSuite suite = CU_add_suite("list of methods", NULL, NULL);
    if (suite == NULL) return 1;
    CU_ADD_TEST(suite, options_have_a_value_at_every_zoom);
    CU_ADD_TEST(suite, wrong_options_are_told_by_name);
    CU_ADD_TEST(suite, the_table_is_in_order);
    CU_ADD_TEST(suite, every_method_triangulates_every_tile);
    CU_ADD_TEST(suite, a_bad_tile_reaches_no_method);
    return 0;
}
