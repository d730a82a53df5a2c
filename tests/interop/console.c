/* Starts a program in this console and ends it after some seconds, as a person or Windows does; for wine.sh.
 *   console.exe HOW SECONDS FILE COMMAND
 * HOW: key (Ctrl-C), window (the console's window is closed), kill, or what Windows tells a program: close, logoff, shutdown.
 * FILE is written at that moment, and again with the exit status once the program has ended.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <windows.h>

static BOOL WINAPI stay(DWORD event) { return event == CTRL_C_EVENT; }

/* As Windows itself tells a program: by a thread in it. */
static BOOL tell(HANDLE program, DWORD event) {
  FARPROC routine = GetProcAddress(GetModuleHandleA("kernelbase"), "CtrlRoutine");
  LPTHREAD_START_ROUTINE start = (LPTHREAD_START_ROUTINE)(void *)routine;
  return routine && CreateRemoteThread(program, 0, 0, start, (void *)(ULONG_PTR)event, 0, 0);
}

static BOOL end(const char *how, HANDLE program) {
  if (!strcmp(how, "key")) return GenerateConsoleCtrlEvent(CTRL_C_EVENT, 0);
  if (!strcmp(how, "window")) return PostMessageA(GetConsoleWindow(), WM_CLOSE, 0, 0);
  if (!strcmp(how, "kill")) return TerminateProcess(program, 1);
  if (!strcmp(how, "close")) return tell(program, CTRL_CLOSE_EVENT);
  if (!strcmp(how, "logoff")) return tell(program, CTRL_LOGOFF_EVENT);
  if (!strcmp(how, "shutdown")) return tell(program, CTRL_SHUTDOWN_EVENT);
  return FALSE;
}

int main(int count, char **words) {
  if (count < 5) return 2;
  char command[4096] = "";
  for (int nth = 4; nth < count; nth++) {
    strncat(command, words[nth], sizeof command - strlen(command) - 2);
    strcat(command, " ");
  }
  STARTUPINFOA start = {.cb = sizeof start};
  PROCESS_INFORMATION program;
  if (!CreateProcessA(0, command, 0, 0, TRUE, 0, 0, 0, &start, &program)) return 1;
  SetConsoleCtrlHandler(stay, TRUE);
  DWORD early = WaitForSingleObject(program.hProcess, 1000 * atoi(words[2]));
  FILE *file = fopen(words[3], "w");
  fprintf(file, "%s: ", words[1]);
  fflush(file);
  BOOL done = early == WAIT_TIMEOUT && end(words[1], program.hProcess);
  fprintf(file, done ? "told" : early == WAIT_TIMEOUT ? "could not be told" : "ended by itself");
  fflush(file);
  DWORD status = 0;
  WaitForSingleObject(program.hProcess, 10000);
  GetExitCodeProcess(program.hProcess, &status);
  fprintf(file, ", status 0x%lx\n", status);
  fclose(file);
  return !done;
}
