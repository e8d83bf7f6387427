#include "src/methods.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- names ---- */

enum scree_status method_choose(const char *name, struct method_choice *choice, struct scree_error *error) {
    char names[512] = "";
    size_t length = 0;
    memset(choice, 0, sizeof *choice);
    for (const struct method *method = method_table; method->name != NULL; method++) {
        if (strcmp(method->name, name) == 0) {
            choice->method = method;
            return SCREE_OK;
        }
        if (length < sizeof names)
            length +=
                (size_t)snprintf(names + length, sizeof names - length, "%s%s", length > 0 ? ", " : "", method->name);
    }
    return scree_fail(error, SCREE_E_ARGUMENT, "there is no method %s; there are: %s", name, names);
}

static const struct method_option *find_option(const struct method *method, const char *name, size_t length) {
    for (int i = 0; i < method->option_count; i++)
        if (strlen(method->options[i].name) == length && strncmp(method->options[i].name, name, length) == 0)
            return &method->options[i];
    return NULL;
}

/* ---- values ---- */

static bool take_number(const char **text, double *value) {
    char *end;
    *value = strtod(*text, &end);
    if (end == *text || !isfinite(*value)) return false;
    *text = end;
    return true;
}

/* 0:50,5:20 from its second character that is no number on: zooms must grow. */
static bool take_list(const char *text, struct method_setting *setting) {
    while (*text != '\0') {
        char *end;
        long zoom = strtol(text, &end, 10);
        if (end == text || *end != ':' || zoom < 0 || zoom > MAX_ZOOM) return false;
        if (setting->count > 0 && zoom <= setting->list[setting->count - 1].zoom) return false;
        text = end + 1;
        setting->list[setting->count].zoom = (int)zoom;
        if (!take_number(&text, &setting->list[setting->count++].value)) return false;
        if (*text == ',' && text[1] != '\0')
            text++;
        else if (*text != '\0')
            return false;
    }
    return setting->count > 0;
}

static bool take_value(const char *text, struct method_setting *setting) {
    const char *rest = text;
    double value;
    *setting = (struct method_setting){.growth = 1};
    if (strchr(text, ':') != NULL) return take_list(text, setting);
    if (!take_number(&rest, &value)) return false;
    setting->count = 1;
    setting->list[0].value = value;
    if (strcmp(rest, "/2") == 0) setting->growth = 0.5;
    if (strcmp(rest, "*2") == 0) setting->growth = 2;
    return *rest == '\0' || setting->growth != 1;
}

static bool is_in_range(const struct method_option *option, double value) {
    return value >= option->least && value <= option->most;
}

static enum scree_status out_of_range(const struct method *method, const struct method_option *option, double value,
                                      int zoom, struct scree_error *error) {
    return scree_fail(error, SCREE_E_ARGUMENT, "option %s of method %s: %g at zoom %d; it takes %g to %g", option->name,
                      method->name, value, zoom, option->least, option->most);
}

enum scree_status method_set(struct method_choice *choice, const char *assignment, struct scree_error *error) {
    const struct method *method = choice->method;
    const char *equals = strchr(assignment, '=');
    if (equals == NULL)
        return scree_fail(error, SCREE_E_ARGUMENT, "an option of a method is written NAME=VALUE, not %s", assignment);
    const struct method_option *option = find_option(method, assignment, (size_t)(equals - assignment));
    if (option == NULL)
        return scree_fail(error, SCREE_E_ARGUMENT, "method %s has no option %.*s", method->name,
                          (int)(equals - assignment), assignment);
    struct method_setting *setting = &choice->settings[option - method->options];
    if (!take_value(equals + 1, setting))
        return scree_fail(error, SCREE_E_ARGUMENT,
                          "option %s of method %s: %s is no value; it takes %g to %g, as in 50, 0:50,5:20, 400/2 or "
                          "4*2",
                          option->name, method->name, equals + 1, option->least, option->most);
    for (int i = 0; i < setting->count; i++)
        if (!is_in_range(option, setting->list[i].value))
            return out_of_range(method, option, setting->list[i].value, setting->list[i].zoom, error);
    return SCREE_OK;
}

/* NAN where the list begins at a later zoom. */
static double value_at(const struct method_setting *setting, int zoom) {
    double value = NAN;
    for (int i = 0; i < setting->count && setting->list[i].zoom <= zoom; i++) value = setting->list[i].value;
    if (setting->growth == 0.5) value = ldexp(value, -zoom);
    if (setting->growth == 2) value = ldexp(value, zoom);
    return value;
}

enum scree_status method_values_at(const struct method_choice *choice, int zoom, double tolerance_m,
                                   double values[METHOD_MAX_OPTIONS], struct scree_error *error) {
    const struct method *method = choice->method;
    for (int i = 0; i < method->option_count; i++) {
        const struct method_option *option = &method->options[i];
        const struct method_setting *setting = &choice->settings[i];
        if (setting->count == 0) {
            values[i] = option->standard;
            if (option->tolerance_part != 0)
                values[i] = fmin(fmax(option->tolerance_part * tolerance_m, option->least), option->most);
            continue;
        }
        values[i] = value_at(setting, zoom);
        if (isnan(values[i]))
            return scree_fail(error, SCREE_E_ARGUMENT,
                              "option %s of method %s: there is no value for zoom %d, the list begins at zoom %d",
                              option->name, method->name, zoom, setting->list[0].zoom);
        if (option->is_whole) values[i] = floor(values[i] + 0.5);
        if (!is_in_range(option, values[i])) return out_of_range(method, option, values[i], zoom, error);
    }
    const char *wrong = method->contradiction != NULL ? method->contradiction(values) : NULL;
    if (wrong == NULL) return SCREE_OK;
    return scree_fail(error, SCREE_E_ARGUMENT, "method %s at zoom %d: %s", method->name, zoom, wrong);
}

enum scree_status method_run(const struct method_choice *choice, int zoom, double tolerance_m,
                             struct scree_memory *memory, const struct method_tile *tile, struct method_mesh *mesh,
                             struct scree_error *error) {
    double values[METHOD_MAX_OPTIONS];
    *mesh = (struct method_mesh){0};
    enum scree_status status = method_values_at(choice, zoom, tolerance_m, values, error);
    if (status == SCREE_OK) status = method_tile_check(tile, error);
    return status == SCREE_OK ? choice->method->run(memory, tile, values, mesh, error) : status;
}
