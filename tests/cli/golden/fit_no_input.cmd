flightwatt fit
