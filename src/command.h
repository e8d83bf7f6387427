/* The commands of the program: `scree COMMAND ...` calls one of these with argv[0] being the command's name.
 *
 * Each parses its own options, answers --help itself, prints its own errors ("scree build: ..." on one line of
 * stderr) and returns the exit code of the process. */
#ifndef SCREE_COMMAND_H
#define SCREE_COMMAND_H

enum exit_code {
    EXIT_DONE = 0,
    EXIT_FAILED = 1, /* the input, the output or a promise that verify found broken */
    EXIT_USAGE = 2   /* the command line makes no sense */
};

int command_build(int argc, char **argv);
int command_info(int argc, char **argv);
int command_verify(int argc, char **argv);
int command_compare(int argc, char **argv);
int command_extract(int argc, char **argv);
int command_remesh(int argc, char **argv);
int command_filter(int argc, char **argv);

#endif
