// CPU time of the calling thread, from lap to lap.
#ifndef SCREE_VIEWER_STOPWATCH_IO_H
#define SCREE_VIEWER_STOPWATCH_IO_H

class Stopwatch {
  public:
    Stopwatch();
    double lap_ms(); // since the last lap

  private:
    double last_ms;
};

#endif
