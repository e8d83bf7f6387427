/* Runs a fuzzing target on files, where libFuzzer is not at hand: each file named by an argument, in an exact-size
 * block, so that a sanitizer sees a read beyond its end. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size_bytes);

static int replay(const char *path) {
    FILE *file = fopen(path, "rb");
    long size_bytes = -1;
    if (file == NULL || fseek(file, 0, SEEK_END) != 0 || (size_bytes = ftell(file)) < 0 ||
        fseek(file, 0, SEEK_SET) != 0) {
        perror(path);
        if (file != NULL) fclose(file);
        return 1;
    }
    uint8_t *data = malloc((size_t)size_bytes + (size_bytes == 0));
    size_t read_bytes = data == NULL ? 0 : fread(data, 1, (size_t)size_bytes, file);
    fclose(file);
    if (data == NULL || read_bytes != (size_t)size_bytes) {
        fprintf(stderr, "%s: could not be read\n", path);
        free(data);
        return 1;
    }
    printf("%s\n", path);
    fflush(stdout); /* a finding stops the program: the last line names the file */
    LLVMFuzzerTestOneInput(data, (size_t)size_bytes);
    free(data);
    return 0;
}

int main(int argc, char **argv) {
    for (int i = 1; i < argc; i++)
        if (replay(argv[i]) != 0) return 1;
    printf("%d files played without a finding\n", argc - 1);
    return argc > 1 ? 0 : 1;
}
