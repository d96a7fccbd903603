cp "$SOURCE/logs/opterra_synthetic_01.data" log.data
flightwatt segment log.data -o log.data; echo $?
cmp log.data "$SOURCE/logs/opterra_synthetic_01.data" && echo unharmed
