flightwatt fit --outptu x something
