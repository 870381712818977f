// All of the page, top to bottom.
document.title = `colod report: ${count(buildings.length, 'building')}`;
showOverview();
showProblems();
const drawPlots = showPlots(), drawPictures = showPictures();
showTable((list, limit) => { drawPlots(list); drawPictures(list, limit); });
showSwitching();
showCoanalysis();
showTime();
showParameters();
