# Install, export and packages.
