/* Rules of land use: see the header. */
#include "src/landuse_rules.h"

#include <stdbool.h>
#include <string.h>

static const char default_rules[] = "water class=water\nshore class=shore\nrailway class=railway\n"
                                    "bridge class=bridge\nroad class=road\nforest class=forest\n";

const char *landuse_name(enum landuse use) {
    static const char *const names[LANDUSE_COUNT] = {"water", "shore", "railway", "bridge", "road", "forest"};
    return use < LANDUSE_COUNT ? names[use] : "none";
}

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/* Cuts blanks off both ends. */
static char *trimmed(char *text) {
    while (is_blank(*text)) text++;
    size_t length = strlen(text);
    while (length > 0 && is_blank(text[length - 1])) text[--length] = '\0';
    return text;
}

/* The line ends with a zero. false: it is no rule; a line without any leaves `use` LANDUSE_COUNT. */
static bool parse_line(char *line, struct landuse_rule *rule) {
    rule->use = LANDUSE_COUNT;
    char *comment = strchr(line, '#');
    if (comment != NULL) *comment = '\0';
    line = trimmed(line);
    if (*line == '\0') return true;
    char *end = line;
    while (*end != '\0' && !is_blank(*end)) end++;
    char *equals = strchr(end, '=');
    if (*end == '\0' || equals == NULL) return false;
    *end = *equals = '\0';
    rule->attribute = trimmed(end + 1);
    rule->value = trimmed(equals + 1);
    if (*rule->attribute == '\0' || *rule->value == '\0') return false;
    if (strcmp(rule->value, "*") == 0) rule->value = NULL;
    for (rule->use = 0; rule->use < LANDUSE_COUNT; rule->use++)
        if (strcmp(line, landuse_name(rule->use)) == 0) return true;
    return false;
}

static size_t count_lines(const char *bytes, size_t size_bytes) {
    size_t lines = 1;
    for (size_t i = 0; i < size_bytes; i++) lines += bytes[i] == '\n';
    return lines;
}

enum scree_status landuse_rules_parse(struct scree_memory *memory, const char *name, const char *bytes,
                                      size_t size_bytes, struct landuse_rules *rules, struct scree_error *error) {
    static const char what[] = "the rules of land use";
    *rules = (struct landuse_rules){.count = 0};
    if (bytes == NULL) {
        bytes = default_rules;
        size_bytes = strlen(default_rules);
    }
    const size_t lines = count_lines(bytes, size_bytes);
    rules->rules = scree_allocate(memory, lines, sizeof *rules->rules, what, error);
    rules->text = scree_allocate(memory, size_bytes + 1, 1, what, error);
    if (rules->rules == NULL || rules->text == NULL) return SCREE_E_MEMORY;
    memcpy(rules->text, bytes, size_bytes);
    char *line = rules->text;
    for (size_t number = 1; number <= lines; number++) {
        char *end = memchr(line, '\n', size_bytes - (size_t)(line - rules->text));
        if (end != NULL) *end = '\0';
        struct landuse_rule *rule = &rules->rules[rules->count];
        if (!parse_line(line, rule))
            return scree_fail(error, SCREE_E_CORRUPT,
                              "%s, line %zu: a rule is water, shore, railway, bridge, road or forest, and then "
                              "ATTRIBUTE=VALUE",
                              name, number);
        rules->count += rule->use != LANDUSE_COUNT;
        if (end != NULL) line = end + 1;
    }
    return rules->count > 0 ? SCREE_OK : scree_fail(error, SCREE_E_CORRUPT, "%s: holds no rule", name);
}

void landuse_rules_free(struct scree_memory *memory, struct landuse_rules *rules) {
    scree_release(memory, rules->text);
    scree_release(memory, rules->rules);
    *rules = (struct landuse_rules){.count = 0};
}
