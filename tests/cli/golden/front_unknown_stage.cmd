flightwatt frobnicate x.data
