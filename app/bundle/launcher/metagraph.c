/* Starts Metagraph with the Python beside it: the window, a project in it, or a command. It is a program and no
   script, since file managers open scripts in an editor. */
#include <errno.h>
#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int main(int count, char **words) {
    char place[PATH_MAX], python[PATH_MAX + 32];
    if (!realpath("/proc/self/exe", place) && !realpath(words[0], place)) {
        perror("metagraph");
        return 1;
    }
    snprintf(python, sizeof python, "%s/python/bin/python3", dirname(place));
    const char *theme = getenv("QT_QPA_PLATFORMTHEME");
    if (!theme || !*theme) /* file dialogs are those of the desktop, where it has some */
        setenv("QT_QPA_PLATFORMTHEME", "xdgdesktopportal", 1);
    char *first[] = {python, "-I", "-X", "utf8", "-B", "-m", "app.cli"};
    size_t known = sizeof first / sizeof *first;
    char **all = calloc(known + (size_t)count + 1, sizeof *all);
    if (!all) {
        perror("metagraph");
        return 1;
    }
    memcpy(all, first, sizeof first);
    for (int i = 1; i < count; i++)
        all[known + (size_t)i - 1] = words[i];
    execv(python, all);
    fprintf(stderr, "metagraph: %s: %s. Unpack the whole folder again.\n", python, strerror(errno));
    return 1;
}
