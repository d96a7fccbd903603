flightwatt ''
