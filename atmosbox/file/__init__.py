"""Files: what a run keeps, and how a file is written whole.

`declaration`  how a variable of a file is declared
`variables`    every variable that a run can put into its file, declared once
`dataset`      the dataset of a run, with CF names and units
`provenance`   where a file comes from: settings, seed, versions
`output_lock`  one writer for one file
`output_path`  the one way to write a file: its path is checked, and it is there whole or not at all
`validity`     what is asked of a file before its numbers are loaded
`heap`         a damage that the library HDF5 does not survive
`netcdf`       datasets to netCDF files, and back
`molecules`    the molecules of a saved run, frame by frame
`checkpoint`   the file of a run that is not finished
"""
