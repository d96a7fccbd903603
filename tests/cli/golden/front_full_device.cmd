flightwatt > /dev/full
