"use strict";

/** Everything of the page, a part for each file. The only global name. */
const report = {};
