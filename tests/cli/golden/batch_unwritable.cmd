touch file; mkdir blocked; mkdir blocked/flights.csv
for output in file /proc/x file/x blocked; do
  flightwatt batch "$SOURCE/logs/opterra_synthetic_02.data" -o $output 2> diagnostics > /dev/null; echo $?; tail -n 1 diagnostics | sed "s,\(/proc/[a-z.]*\): .*,\1: CAUSE,"
done
