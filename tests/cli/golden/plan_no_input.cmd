flightwatt plan
