// What Unicode says of letters, as far as speech needs it; made from Python's unicodedata. Not for reading.
#pragma once

#include <cstdint>

namespace metagraph {
namespace letters_table {

struct PlainLetters {
    const char* plain;
    const char* letters;
};

// Small letters without accents, and the Latin, Greek, Cyrillic and Kana letters that stand for them.
inline constexpr PlainLetters PLAIN[] = {
    {"a", "AÀÁÂÃÄÅàáâãäåĀāĂăĄąǍǎǞǟǠǡǺǻȀȁȂȃȦȧḀḁẠạẢảẤấẦầẨẩẪẫẬậẮắẰằẲẳẴẵẶặ"},
    {"b", "BḂḃḄḅḆḇ"},
    {"c", "CÇçĆćĈĉĊċČčḈḉ"},
    {"d", "DĎďḊḋḌḍḎḏḐḑḒḓ"},
    {"e", "EÈÉÊËèéêëĒēĔĕĖėĘęĚěȄȅȆȇȨȩḔḕḖḗḘḙḚḛḜḝẸẹẺẻẼẽẾếỀềỂểỄễỆệ"},
    {"f", "FḞḟ"},
    {"g", "GĜĝĞğĠġĢģǦǧǴǵḠḡ"},
    {"h", "HĤĥȞȟḢḣḤḥḦḧḨḩḪḫẖ"},
    {"i", "IÌÍÎÏìíîïĨĩĪīĬĭĮįİǏǐȈȉȊȋḬḭḮḯỈỉỊị"},
    {"j", "JĴĵǰ"},
    {"k", "KĶķǨǩḰḱḲḳḴḵ"},
    {"l", "LĹĺĻļĽľḶḷḸḹḺḻḼḽ"},
    {"m", "MḾḿṀṁṂṃ"},
    {"n", "NÑñŃńŅņŇňǸǹṄṅṆṇṈṉṊṋ"},
    {"o", "OÒÓÔÕÖòóôõöŌōŎŏŐőƠơǑǒǪǫǬǭȌȍȎȏȪȫȬȭȮȯȰȱṌṍṎṏṐṑṒṓỌọỎỏỐốỒồỔổỖỗỘộỚớỜờỞởỠỡỢợ"},
    {"p", "PṔṕṖṗ"},
    {"r", "RŔŕŖŗŘřȐȑȒȓṘṙṚṛṜṝṞṟ"},
    {"s", "SŚśŜŝŞşŠšſȘșṠṡṢṣṤṥṦṧṨṩẛ"},
    {"t", "TŢţŤťȚțṪṫṬṭṮṯṰṱẗ"},
    {"u", "UÙÚÛÜùúûüŨũŪūŬŭŮůŰűŲųƯưǓǔǕǖǗǘǙǚǛǜȔȕȖȗṲṳṴṵṶṷṸṹṺṻỤụỦủỨứỪừỬửỮữỰự"},
    {"v", "VṼṽṾṿ"},
    {"w", "WŴŵẀẁẂẃẄẅẆẇẈẉẘ"},
    {"x", "XẊẋẌẍ"},
    {"y", "YÝýÿŶŷŸȲȳẎẏẙỲỳỴỵỶỷỸỹ"},
    {"z", "ZŹźŻżŽžẐẑẒẓẔẕ"},
    {"μ", "µΜ"},
    {"æ", "ÆǢǣǼǽ"},
    {"ø", "ØǾǿ"},
    {"ss", "ßẞ"},
    {"ʼn", "ŉ"},
    {"ʒ", "ƷǮǯ"},
    {"ǆ", "Ǆǅ"},
    {"ǉ", "Ǉǈ"},
    {"ǌ", "Ǌǋ"},
    {"ǳ", "Ǳǲ"},
    {"α", "ΆΑάἀἁἂἃἄἅἆἇἈἉἊἋἌἍἎἏὰάᾰᾱᾶᾸᾹᾺΆ"},
    {"ε", "ΈΕέϵἐἑἒἓἔἕἘἙἚἛἜἝὲέῈΈ"},
    {"η", "ΉΗήἠἡἢἣἤἥἦἧἨἩἪἫἬἭἮἯὴήῆῊΉ"},
    {"ι", "ΊΐΙΪίϊἰἱἲἳἴἵἶἷἸἹἺἻἼἽἾἿὶίιῐῑῒΐῖῗῘῙῚΊ"},
    {"ο", "ΌΟόὀὁὂὃὄὅὈὉὊὋὌὍὸόῸΌ"},
    {"υ", "ΎΥΫΰϋύὐὑὒὓὔὕὖὗὙὛὝὟὺύῠῡῢΰῦῧῨῩῪΎ"},
    {"ω", "ΏΩώὠὡὢὣὤὥὦὧὨὩὪὫὬὭὮὯὼώῶῺΏ"},
    {"β", "Βϐ"},
    {"θ", "Θϑϴ"},
    {"κ", "Κϰ"},
    {"π", "Πϖ"},
    {"ρ", "ΡϱῤῥῬ"},
    {"σ", "Σς"},
    {"φ", "Φϕ"},
    {"ϒ", "ϓϔ"},
    {"е", "ЀЁЕѐёӖӗ"},
    {"г", "ЃГѓ"},
    {"і", "ІЇї"},
    {"к", "ЌКќ"},
    {"и", "ЍИЙйѝӢӣӤӥ"},
    {"у", "ЎУўӮӯӰӱӲӳ"},
    {"а", "АӐӑӒӓ"},
    {"ж", "ЖӁӂӜӝ"},
    {"з", "ЗӞӟ"},
    {"о", "ОӦӧ"},
    {"ч", "ЧӴӵ"},
    {"ы", "ЫӸӹ"},
    {"э", "ЭӬӭ"},
    {"ѵ", "ѴѶѷ"},
    {"ә", "ӘӚӛ"},
    {"ө", "ӨӪӫ"},
    {"aʾ", "ẚ"},
    {"αι", "ᾀᾁᾂᾃᾄᾅᾆᾇᾈᾉᾊᾋᾌᾍᾎᾏᾲᾳᾴᾷᾼ"},
    {"ηι", "ᾐᾑᾒᾓᾔᾕᾖᾗᾘᾙᾚᾛᾜᾝᾞᾟῂῃῄῇῌ"},
    {"ωι", "ᾠᾡᾢᾣᾤᾥᾦᾧᾨᾩᾪᾫᾬᾭᾮᾯῲῳῴῷῼ"},
    {"は", "ばぱ"},
    {"ひ", "びぴ"},
    {"ふ", "ぶぷ"},
    {"へ", "べぺ"},
    {"ほ", "ぼぽ"},
    {"ハ", "バパ"},
    {"ヒ", "ビピ"},
    {"フ", "ブプ"},
    {"ヘ", "ベペ"},
    {"ホ", "ボポ"},
};
// The same for those that stand alone, in pairs: the letter, then its plain one.
inline constexpr char PAIRS[] =
    "QqÐðÞþĐđĦħĲĳĿŀŁłŊŋŒœŦŧƁɓƂƃƄƅƆɔƇƈƉɖƊɗƋƌƎǝƏəƐɛƑƒƓɠƔɣƖɩƗɨƘƙƜɯƝɲƟɵƢƣƤƥƦʀƧƨƩʃƬƭƮʈƱʊƲʋƳƴƵƶƸƹƼƽǤǥǶƕǷƿȜȝȠƞȢȣ"
    "ȤȥȺⱥȻȼȽƚȾⱦɁɂɃƀɄʉɅʌɆɇɈɉɊɋɌɍɎɏͰͱͲͳʹʹͶͷͿϳΓγΔδΖζΛλΝνΞξΤτΧχΨψϏϗϘϙϚϛϜϝϞϟϠϡϢϣϤϥϦϧϨϩϪϫϬϭϮϯϷϸϹϲϺϻϽͻϾͼϿͽЂђЄєЅѕ"
    "ЈјЉљЊњЋћЏџБбВвДдЛлМмНнПпРрСсТтФфХхЦцШшЩщЪъЬьЮюЯяѠѡѢѣѤѥѦѧѨѩѪѫѬѭѮѯѰѱѲѳѸѹѺѻѼѽѾѿҀҁҊҋҌҍҎҏҐґҒғҔҕҖҗҘҙҚқҜҝҞҟ"
    "ҠҡҢңҤҥҦҧҨҩҪҫҬҭҮүҰұҲҳҴҵҶҷҸҹҺһҼҽҾҿӀӏӃӄӅӆӇӈӉӊӋӌӍӎӔӕӠӡӶӷӺӻӼӽӾӿԀԁԂԃԄԅԆԇԈԉԊԋԌԍԎԏԐԑԒԓԔԕԖԗԘԙԚԛԜԝԞԟԠԡԢԣԤԥԦԧԨԩ"
    "ԪԫԬԭԮԯỺỻỼỽỾỿがかぎきぐくげけごこざさじしずすぜせぞそだたぢちづつでてどとゔうゞゝガカギキグクゲケゴコザサジシズスゼセゾソダタヂチヅツデテドトヴウヷワヸヰヹヱヺヲヾヽ";
// Letters and digits, as runs: how many code points are passed over, then how many belong.
inline constexpr std::uint32_t LETTERS[] = {
    48, 10, 7, 26, 6, 26, 47, 1, 7, 2, 1, 1, 3, 2, 1, 3, 1, 23, 1, 31, 1, 458, 4, 12, 14, 5, 7, 1, 1, 1, 129, 5, 1, 2,
    2, 4, 1, 1, 6, 1, 1, 3, 1, 1, 1, 20, 1, 83, 1, 139, 8, 166, 1, 38, 2, 1, 6, 41, 71, 27, 4, 4, 45, 43, 21, 10, 4,
    2, 1, 99, 1, 1, 15, 2, 7, 15, 2, 1, 16, 1, 1, 30, 29, 89, 11, 1, 14, 43, 9, 2, 4, 1, 5, 22, 4, 1, 9, 1, 3, 1, 23,
    25, 7, 11, 5, 24, 1, 6, 17, 42, 58, 54, 3, 1, 18, 1, 7, 10, 4, 10, 1, 16, 4, 8, 2, 2, 2, 22, 1, 7, 1, 1, 3, 4, 3,
    1, 16, 1, 13, 2, 1, 3, 4, 12, 2, 6, 2, 1, 8, 6, 4, 2, 2, 22, 1, 7, 1, 2, 1, 2, 1, 2, 31, 4, 1, 1, 7, 10, 2, 3, 16,
    9, 1, 3, 1, 22, 1, 7, 1, 2, 1, 5, 3, 1, 18, 1, 15, 2, 4, 10, 9, 1, 11, 8, 2, 2, 2, 22, 1, 7, 1, 2, 1, 5, 3, 1, 30,
    2, 1, 3, 4, 10, 1, 7, 11, 1, 1, 6, 3, 3, 1, 4, 3, 2, 1, 1, 1, 2, 3, 2, 3, 3, 3, 12, 22, 1, 21, 13, 18, 8, 1, 3, 1,
    23, 1, 16, 3, 1, 26, 3, 2, 1, 2, 2, 4, 10, 8, 7, 1, 1, 4, 8, 1, 3, 1, 23, 1, 10, 1, 5, 3, 1, 31, 2, 1, 2, 4, 10,
    1, 2, 17, 9, 1, 3, 1, 41, 2, 1, 16, 1, 5, 3, 1, 10, 4, 19, 1, 6, 5, 18, 3, 24, 1, 9, 1, 1, 2, 7, 31, 10, 17, 48,
    1, 2, 12, 7, 9, 10, 39, 2, 1, 1, 1, 5, 1, 24, 1, 1, 1, 10, 1, 2, 9, 1, 2, 5, 1, 1, 9, 10, 2, 4, 32, 1, 31, 20, 12,
    8, 1, 36, 27, 5, 115, 43, 20, 11, 6, 6, 4, 4, 3, 1, 3, 2, 7, 3, 4, 13, 12, 1, 1, 10, 6, 38, 1, 1, 5, 1, 2, 43, 1,
    333, 1, 4, 2, 7, 1, 1, 1, 4, 2, 41, 1, 4, 2, 33, 1, 4, 2, 7, 1, 1, 1, 4, 2, 15, 1, 57, 1, 4, 2, 67, 14, 20, 3, 16,
    16, 86, 2, 6, 3, 620, 2, 17, 1, 26, 5, 75, 3, 11, 7, 18, 13, 19, 14, 18, 14, 13, 1, 3, 15, 52, 35, 1, 4, 1, 3, 10,
    6, 10, 22, 10, 6, 89, 7, 5, 2, 34, 1, 1, 5, 70, 10, 31, 39, 40, 2, 5, 11, 44, 4, 26, 6, 11, 37, 23, 9, 53, 43, 10,
    6, 10, 13, 1, 93, 47, 17, 8, 3, 10, 41, 30, 13, 56, 26, 36, 28, 10, 3, 49, 2, 9, 7, 43, 2, 3, 41, 4, 1, 6, 1, 2,
    3, 1, 5, 192, 64, 278, 2, 6, 2, 38, 2, 6, 2, 8, 1, 1, 1, 1, 1, 1, 1, 31, 2, 53, 1, 7, 1, 1, 3, 3, 1, 7, 3, 4, 2,
    6, 4, 13, 5, 3, 1, 7, 115, 2, 2, 6, 5, 11, 6, 13, 101, 1, 4, 1, 2, 10, 1, 1, 3, 5, 6, 1, 1, 1, 1, 1, 1, 4, 1, 11,
    2, 4, 5, 5, 4, 1, 1, 58, 726, 60, 78, 22, 630, 30, 1132, 229, 6, 4, 3, 2, 9, 1, 2, 38, 1, 1, 5, 1, 2, 56, 7, 1,
    16, 23, 9, 7, 1, 7, 1, 7, 1, 7, 1, 7, 1, 7, 1, 7, 1, 7, 80, 1, 469, 3, 25, 9, 7, 5, 2, 5, 4, 86, 6, 3, 1, 90, 1,
    4, 5, 43, 1, 94, 3, 4, 10, 32, 48, 16, 32, 10, 30, 8, 1, 15, 32, 10, 39, 15, 320, 6592, 64, 22157, 67, 46, 2, 269,
    3, 28, 20, 47, 16, 31, 2, 80, 39, 9, 2, 103, 2, 64, 5, 2, 1, 1, 1, 5, 24, 16, 1, 3, 1, 4, 1, 23, 13, 6, 10, 52,
    14, 50, 28, 10, 24, 6, 3, 1, 1, 2, 1, 38, 10, 23, 25, 29, 7, 47, 28, 11, 6, 5, 1, 25, 1, 41, 23, 3, 1, 8, 4, 10,
    6, 23, 3, 1, 3, 50, 1, 1, 3, 2, 2, 5, 2, 1, 1, 1, 24, 3, 2, 11, 7, 3, 12, 6, 2, 6, 2, 6, 9, 7, 1, 7, 1, 43, 1, 14,
    6, 115, 13, 10, 6, 11172, 12, 23, 4, 49, 8452, 366, 2, 106, 38, 7, 12, 5, 5, 1, 1, 10, 1, 13, 1, 5, 1, 1, 1, 2, 1,
    2, 1, 108, 33, 363, 18, 64, 2, 54, 40, 12, 116, 5, 1, 135, 19, 10, 7, 26, 6, 26, 11, 89, 3, 6, 2, 6, 2, 6, 2, 3,
};
// Digits, as runs.
inline constexpr std::uint32_t DIGITS[] = {
    48, 10, 120, 2, 5, 1, 1446, 10, 134, 10, 198, 10, 412, 10, 118, 10, 118, 10, 118, 10, 118, 10, 118, 10, 118, 10,
    118, 10, 118, 10, 118, 10, 96, 10, 118, 10, 70, 10, 278, 10, 70, 10, 719, 9, 1134, 10, 38, 10, 300, 10, 128, 11,
    165, 10, 6, 10, 182, 10, 86, 10, 134, 10, 6, 10, 1046, 1, 3, 6, 6, 10, 982, 9, 11, 9, 11, 9, 89, 1, 10, 9, 1, 1,
    630, 9, 1, 9, 1, 9, 32397, 10, 678, 10, 38, 10, 198, 10, 22, 10, 86, 10, 406, 10, 21270, 10,
};
// Letters without case, most of them a syllable or a word each, as runs.
inline constexpr std::uint32_t SYLLABLES[] = {
    170, 1, 15, 1, 256, 1, 4, 4, 208, 1, 827, 27, 4, 4, 45, 32, 1, 10, 35, 2, 1, 99, 1, 1, 24, 2, 10, 3, 2, 1, 16, 1,
    1, 30, 29, 89, 11, 1, 24, 33, 21, 22, 42, 25, 7, 11, 5, 24, 1, 6, 17, 41, 59, 54, 3, 1, 18, 1, 7, 10, 16, 15, 4,
    8, 2, 2, 2, 22, 1, 7, 1, 1, 3, 4, 3, 1, 16, 1, 13, 2, 1, 3, 14, 2, 10, 1, 8, 6, 4, 2, 2, 22, 1, 7, 1, 2, 1, 2, 1,
    2, 31, 4, 1, 1, 19, 3, 16, 9, 1, 3, 1, 22, 1, 7, 1, 2, 1, 5, 3, 1, 18, 1, 15, 2, 23, 1, 11, 8, 2, 2, 2, 22, 1, 7,
    1, 2, 1, 5, 3, 1, 30, 2, 1, 3, 15, 1, 17, 1, 1, 6, 3, 3, 1, 4, 3, 2, 1, 1, 1, 2, 3, 2, 3, 3, 3, 12, 22, 1, 52, 8,
    1, 3, 1, 23, 1, 16, 3, 1, 26, 3, 2, 1, 2, 2, 30, 1, 4, 8, 1, 3, 1, 23, 1, 10, 1, 5, 3, 1, 31, 2, 1, 2, 15, 2, 17,
    9, 1, 3, 1, 41, 2, 1, 16, 1, 5, 3, 8, 3, 24, 6, 5, 18, 3, 24, 1, 9, 1, 1, 2, 7, 58, 48, 1, 2, 12, 6, 59, 2, 1, 1,
    1, 5, 1, 24, 1, 1, 1, 10, 1, 2, 9, 1, 2, 5, 23, 4, 32, 1, 63, 8, 1, 36, 27, 5, 115, 43, 20, 1, 16, 6, 4, 4, 3, 1,
    3, 2, 7, 3, 4, 13, 12, 1, 113, 329, 1, 4, 2, 7, 1, 1, 1, 4, 2, 41, 1, 4, 2, 33, 1, 4, 2, 7, 1, 1, 1, 4, 2, 15, 1,
    57, 1, 4, 2, 67, 37, 16, 113, 620, 2, 17, 1, 26, 5, 75, 6, 8, 7, 18, 13, 19, 14, 18, 14, 13, 1, 3, 15, 52, 40, 1,
    67, 35, 1, 53, 7, 5, 2, 34, 1, 1, 5, 70, 10, 31, 49, 30, 2, 5, 11, 44, 4, 26, 54, 23, 9, 53, 176, 47, 17, 8, 54,
    30, 13, 2, 10, 44, 26, 36, 41, 3, 10, 30, 113, 4, 1, 6, 1, 2, 3, 1, 1082, 4, 3063, 56, 24, 23, 9, 7, 1, 7, 1, 7,
    1, 7, 1, 7, 1, 7, 1, 7, 1, 7, 551, 1, 53, 1, 4, 86, 8, 1, 1, 90, 4, 1, 5, 43, 1, 94, 17, 32, 48, 16, 512, 6592,
    64, 21013, 1, 1143, 67, 40, 8, 268, 4, 16, 10, 2, 66, 1, 49, 70, 169, 1, 103, 1, 3, 7, 1, 3, 1, 4, 1, 23, 29, 52,
    14, 50, 62, 6, 3, 1, 1, 2, 11, 28, 10, 23, 25, 29, 7, 47, 45, 5, 2, 9, 10, 5, 1, 41, 23, 3, 1, 8, 20, 16, 1, 6, 3,
    1, 3, 50, 1, 1, 3, 2, 2, 5, 2, 1, 1, 1, 24, 2, 3, 11, 7, 1, 14, 6, 2, 6, 2, 6, 9, 7, 1, 7, 145, 35, 29, 11172, 12,
    23, 4, 49, 8452, 366, 2, 106, 67, 1, 1, 10, 1, 13, 1, 5, 1, 1, 1, 2, 1, 2, 1, 108, 33, 363, 18, 64, 2, 54, 40, 12,
    116, 5, 1, 135, 105, 10, 1, 45, 2, 31, 3, 6, 2, 6, 2, 6, 2, 3,
};
// Marks that combine with the letter before them, as runs.
inline constexpr std::uint32_t MARKS[] = {
    768, 79, 1, 32, 275, 5, 265, 45, 1, 1, 1, 2, 1, 2, 1, 1, 72, 11, 48, 21, 16, 1, 101, 7, 2, 6, 2, 2, 1, 4, 35, 1,
    30, 27, 160, 9, 9, 1, 24, 4, 1, 9, 1, 3, 1, 5, 43, 3, 60, 8, 42, 24, 1, 29, 60, 1, 16, 1, 3, 4, 103, 1, 16, 1, 48,
    1, 61, 1, 16, 1, 110, 1, 16, 1, 110, 1, 16, 1, 127, 1, 110, 1, 16, 1, 7, 2, 101, 1, 16, 1, 109, 2, 16, 1, 124, 1,
    109, 3, 13, 4, 108, 3, 13, 4, 76, 2, 27, 1, 1, 1, 1, 1, 55, 2, 1, 1, 5, 4, 2, 1, 1, 3, 1, 2, 62, 1, 112, 1, 1, 2,
    82, 1, 719, 3, 948, 2, 30, 1, 157, 1, 10, 1, 203, 1, 143, 3, 219, 2, 71, 1, 20, 8, 2, 1, 48, 14, 1, 16, 101, 1,
    15, 1, 38, 9, 54, 2, 58, 1, 11, 2, 67, 1, 152, 3, 1, 13, 1, 7, 4, 1, 6, 1, 3, 2, 198, 64, 720, 13, 4, 1, 3, 12,
    3070, 3, 141, 1, 96, 32, 554, 6, 105, 2, 30164, 1, 4, 10, 32, 2, 80, 2, 276, 1, 37, 1, 151, 1, 27, 18, 57, 3, 37,
    1, 95, 1, 12, 1, 239, 1, 1, 3, 2, 2, 5, 2, 1, 1, 52, 1, 246, 1, 20272, 1, 769, 16,
};

// Other letters below 65536, each followed by its plain form.
inline constexpr const char* SPELLED =
    "\u0345\u03b9 \u037e; \u0385\u00a8 \u0387\u00b7 \u0531\u0561 \u0532\u0562 \u0533\u0563 \u0534\u0564 \u0535\u0565 "
    "\u0536\u0566 \u0537\u0567 \u0538\u0568 \u0539\u0569 \u053a\u056a \u053b\u056b \u053c\u056c \u053d\u056d \u053e\u056e "
    "\u053f\u056f \u0540\u0570 \u0541\u0571 \u0542\u0572 \u0543\u0573 \u0544\u0574 \u0545\u0575 \u0546\u0576 \u0547\u0577 "
    "\u0548\u0578 \u0549\u0579 \u054a\u057a \u054b\u057b \u054c\u057c \u054d\u057d \u054e\u057e \u054f\u057f \u0550\u0580 "
    "\u0551\u0581 \u0552\u0582 \u0553\u0583 \u0554\u0584 \u0555\u0585 \u0556\u0586 \u0587\u0565\u0582 \u0622\u0627 "
    "\u0623\u0627 \u0624\u0648 \u0625\u0627 \u0626\u064a \u06c0\u06d5 \u06c2\u06c1 \u06d3\u06d2 \u0929\u0928 \u0931\u0930 "
    "\u0934\u0933 \u0958\u0915 \u0959\u0916 \u095a\u0917 \u095b\u091c \u095c\u0921 \u095d\u0922 \u095e\u092b \u095f\u092f "
    "\u09cb\u09c7\u09be \u09cc\u09c7\u09d7 \u09dc\u09a1 \u09dd\u09a2 \u09df\u09af \u0a33\u0a32 \u0a36\u0a38 \u0a59\u0a16 "
    "\u0a5a\u0a17 \u0a5b\u0a1c \u0a5e\u0a2b \u0b48\u0b47\u0b56 \u0b4b\u0b47\u0b3e \u0b4c\u0b47\u0b57 \u0b5c\u0b21 "
    "\u0b5d\u0b22 \u0b94\u0b92\u0bd7 \u0bca\u0bc6\u0bbe \u0bcb\u0bc7\u0bbe \u0bcc\u0bc6\u0bd7 \u0c48\u0c46 "
    "\u0cc0\u0cbf\u0cd5 \u0cc7\u0cc6\u0cd5 \u0cc8\u0cc6\u0cd6 \u0cca\u0cc6\u0cc2 \u0ccb\u0cc6\u0cc2\u0cd5 "
    "\u0d4a\u0d46\u0d3e \u0d4b\u0d47\u0d3e \u0d4c\u0d46\u0d57 \u0dda\u0dd9 \u0ddc\u0dd9\u0dcf \u0ddd\u0dd9\u0dcf "
    "\u0dde\u0dd9\u0ddf \u0f43\u0f42\u0fb7 \u0f4d\u0f4c\u0fb7 \u0f52\u0f51\u0fb7 \u0f57\u0f56\u0fb7 \u0f5c\u0f5b\u0fb7 "
    "\u0f69\u0f40\u0fb5 \u0f73 \u0f75 \u0f76\u0fb2 \u0f78\u0fb3 \u0f81 \u0f93\u0f92\u0fb7 \u0f9d\u0f9c\u0fb7 "
    "\u0fa2\u0fa1\u0fb7 \u0fa7\u0fa6\u0fb7 \u0fac\u0fab\u0fb7 \u0fb9\u0f90\u0fb5 \u1026\u1025\u102e \u10a0\u2d00 "
    "\u10a1\u2d01 \u10a2\u2d02 \u10a3\u2d03 \u10a4\u2d04 \u10a5\u2d05 \u10a6\u2d06 \u10a7\u2d07 \u10a8\u2d08 \u10a9\u2d09 "
    "\u10aa\u2d0a \u10ab\u2d0b \u10ac\u2d0c \u10ad\u2d0d \u10ae\u2d0e \u10af\u2d0f \u10b0\u2d10 \u10b1\u2d11 \u10b2\u2d12 "
    "\u10b3\u2d13 \u10b4\u2d14 \u10b5\u2d15 \u10b6\u2d16 \u10b7\u2d17 \u10b8\u2d18 \u10b9\u2d19 \u10ba\u2d1a \u10bb\u2d1b "
    "\u10bc\u2d1c \u10bd\u2d1d \u10be\u2d1e \u10bf\u2d1f \u10c0\u2d20 \u10c1\u2d21 \u10c2\u2d22 \u10c3\u2d23 \u10c4\u2d24 "
    "\u10c5\u2d25 \u10c7\u2d27 \u10cd\u2d2d \u13f8\u13f0 \u13f9\u13f1 \u13fa\u13f2 \u13fb\u13f3 \u13fc\u13f4 \u13fd\u13f5 "
    "\u1b06\u1b05\u1b35 \u1b08\u1b07\u1b35 \u1b0a\u1b09\u1b35 \u1b0c\u1b0b\u1b35 \u1b0e\u1b0d\u1b35 \u1b12\u1b11\u1b35 "
    "\u1b3b\u1b3a\u1b35 \u1b3d\u1b3c\u1b35 \u1b40\u1b3e\u1b35 \u1b41\u1b3f\u1b35 \u1b43\u1b42\u1b35 \u1c80\u0432 "
    "\u1c81\u0434 \u1c82\u043e \u1c83\u0441 \u1c84\u0442 \u1c85\u0442 \u1c86\u044a \u1c87\u0463 \u1c88\ua64b \u1c90\u10d0 "
    "\u1c91\u10d1 \u1c92\u10d2 \u1c93\u10d3 \u1c94\u10d4 \u1c95\u10d5 \u1c96\u10d6 \u1c97\u10d7 \u1c98\u10d8 \u1c99\u10d9 "
    "\u1c9a\u10da \u1c9b\u10db \u1c9c\u10dc \u1c9d\u10dd \u1c9e\u10de \u1c9f\u10df \u1ca0\u10e0 \u1ca1\u10e1 \u1ca2\u10e2 "
    "\u1ca3\u10e3 \u1ca4\u10e4 \u1ca5\u10e5 \u1ca6\u10e6 \u1ca7\u10e7 \u1ca8\u10e8 \u1ca9\u10e9 \u1caa\u10ea \u1cab\u10eb "
    "\u1cac\u10ec \u1cad\u10ed \u1cae\u10ee \u1caf\u10ef \u1cb0\u10f0 \u1cb1\u10f1 \u1cb2\u10f2 \u1cb3\u10f3 \u1cb4\u10f4 "
    "\u1cb5\u10f5 \u1cb6\u10f6 \u1cb7\u10f7 \u1cb8\u10f8 \u1cb9\u10f9 \u1cba\u10fa \u1cbd\u10fd \u1cbe\u10fe \u1cbf\u10ff "
    "\u1fc1\u00a8 \u1fcd\u1fbf \u1fce\u1fbf \u1fcf\u1fbf \u1fdd\u1ffe \u1fde\u1ffe \u1fdf\u1ffe \u1fed\u00a8 \u1fee\u00a8 "
    "\u1fef` \u1ffd\u00b4 \u2000\u2002 \u2001\u2003 \u2126\u03c9 \u212ak \u212ba \u2132\u214e \u2160\u2170 \u2161\u2171 "
    "\u2162\u2172 \u2163\u2173 \u2164\u2174 \u2165\u2175 \u2166\u2176 \u2167\u2177 \u2168\u2178 \u2169\u2179 \u216a\u217a "
    "\u216b\u217b \u216c\u217c \u216d\u217d \u216e\u217e \u216f\u217f \u2183\u2184 \u219a\u2190 \u219b\u2192 \u21ae\u2194 "
    "\u21cd\u21d0 \u21ce\u21d4 \u21cf\u21d2 \u2204\u2203 \u2209\u2208 \u220c\u220b \u2224\u2223 \u2226\u2225 \u2241\u223c "
    "\u2244\u2243 \u2247\u2245 \u2249\u2248 \u2260= \u2262\u2261 \u226d\u224d \u226e< \u226f> \u2270\u2264 \u2271\u2265 "
    "\u2274\u2272 \u2275\u2273 \u2278\u2276 \u2279\u2277 \u2280\u227a \u2281\u227b \u2284\u2282 \u2285\u2283 \u2288\u2286 "
    "\u2289\u2287 \u22ac\u22a2 \u22ad\u22a8 \u22ae\u22a9 \u22af\u22ab \u22e0\u227c \u22e1\u227d \u22e2\u2291 \u22e3\u2292 "
    "\u22ea\u22b2 \u22eb\u22b3 \u22ec\u22b4 \u22ed\u22b5 \u2329\u3008 \u232a\u3009 \u24b6\u24d0 \u24b7\u24d1 \u24b8\u24d2 "
    "\u24b9\u24d3 \u24ba\u24d4 \u24bb\u24d5 \u24bc\u24d6 \u24bd\u24d7 \u24be\u24d8 \u24bf\u24d9 \u24c0\u24da \u24c1\u24db "
    "\u24c2\u24dc \u24c3\u24dd \u24c4\u24de \u24c5\u24df \u24c6\u24e0 \u24c7\u24e1 \u24c8\u24e2 \u24c9\u24e3 \u24ca\u24e4 "
    "\u24cb\u24e5 \u24cc\u24e6 \u24cd\u24e7 \u24ce\u24e8 \u24cf\u24e9 \u2adc\u2add \u2c00\u2c30 \u2c01\u2c31 \u2c02\u2c32 "
    "\u2c03\u2c33 \u2c04\u2c34 \u2c05\u2c35 \u2c06\u2c36 \u2c07\u2c37 \u2c08\u2c38 \u2c09\u2c39 \u2c0a\u2c3a \u2c0b\u2c3b "
    "\u2c0c\u2c3c \u2c0d\u2c3d \u2c0e\u2c3e \u2c0f\u2c3f \u2c10\u2c40 \u2c11\u2c41 \u2c12\u2c42 \u2c13\u2c43 \u2c14\u2c44 "
    "\u2c15\u2c45 \u2c16\u2c46 \u2c17\u2c47 \u2c18\u2c48 \u2c19\u2c49 \u2c1a\u2c4a \u2c1b\u2c4b \u2c1c\u2c4c \u2c1d\u2c4d "
    "\u2c1e\u2c4e \u2c1f\u2c4f \u2c20\u2c50 \u2c21\u2c51 \u2c22\u2c52 \u2c23\u2c53 \u2c24\u2c54 \u2c25\u2c55 \u2c26\u2c56 "
    "\u2c27\u2c57 \u2c28\u2c58 \u2c29\u2c59 \u2c2a\u2c5a \u2c2b\u2c5b \u2c2c\u2c5c \u2c2d\u2c5d \u2c2e\u2c5e \u2c2f\u2c5f "
    "\u2c60\u2c61 \u2c62\u026b \u2c63\u1d7d \u2c64\u027d \u2c67\u2c68 \u2c69\u2c6a \u2c6b\u2c6c \u2c6d\u0251 \u2c6e\u0271 "
    "\u2c6f\u0250 \u2c70\u0252 \u2c72\u2c73 \u2c75\u2c76 \u2c7e\u023f \u2c7f\u0240 \u2c80\u2c81 \u2c82\u2c83 \u2c84\u2c85 "
    "\u2c86\u2c87 \u2c88\u2c89 \u2c8a\u2c8b \u2c8c\u2c8d \u2c8e\u2c8f \u2c90\u2c91 \u2c92\u2c93 \u2c94\u2c95 \u2c96\u2c97 "
    "\u2c98\u2c99 \u2c9a\u2c9b \u2c9c\u2c9d \u2c9e\u2c9f \u2ca0\u2ca1 \u2ca2\u2ca3 \u2ca4\u2ca5 \u2ca6\u2ca7 \u2ca8\u2ca9 "
    "\u2caa\u2cab \u2cac\u2cad \u2cae\u2caf \u2cb0\u2cb1 \u2cb2\u2cb3 \u2cb4\u2cb5 \u2cb6\u2cb7 \u2cb8\u2cb9 \u2cba\u2cbb "
    "\u2cbc\u2cbd \u2cbe\u2cbf \u2cc0\u2cc1 \u2cc2\u2cc3 \u2cc4\u2cc5 \u2cc6\u2cc7 \u2cc8\u2cc9 \u2cca\u2ccb \u2ccc\u2ccd "
    "\u2cce\u2ccf \u2cd0\u2cd1 \u2cd2\u2cd3 \u2cd4\u2cd5 \u2cd6\u2cd7 \u2cd8\u2cd9 \u2cda\u2cdb \u2cdc\u2cdd \u2cde\u2cdf "
    "\u2ce0\u2ce1 \u2ce2\u2ce3 \u2ceb\u2cec \u2ced\u2cee \u2cf2\u2cf3 \ua640\ua641 \ua642\ua643 \ua644\ua645 \ua646\ua647 "
    "\ua648\ua649 \ua64a\ua64b \ua64c\ua64d \ua64e\ua64f \ua650\ua651 \ua652\ua653 \ua654\ua655 \ua656\ua657 \ua658\ua659 "
    "\ua65a\ua65b \ua65c\ua65d \ua65e\ua65f \ua660\ua661 \ua662\ua663 \ua664\ua665 \ua666\ua667 \ua668\ua669 \ua66a\ua66b "
    "\ua66c\ua66d \ua680\ua681 \ua682\ua683 \ua684\ua685 \ua686\ua687 \ua688\ua689 \ua68a\ua68b \ua68c\ua68d \ua68e\ua68f "
    "\ua690\ua691 \ua692\ua693 \ua694\ua695 \ua696\ua697 \ua698\ua699 \ua69a\ua69b \ua722\ua723 \ua724\ua725 \ua726\ua727 "
    "\ua728\ua729 \ua72a\ua72b \ua72c\ua72d \ua72e\ua72f \ua732\ua733 \ua734\ua735 \ua736\ua737 \ua738\ua739 \ua73a\ua73b "
    "\ua73c\ua73d \ua73e\ua73f \ua740\ua741 \ua742\ua743 \ua744\ua745 \ua746\ua747 \ua748\ua749 \ua74a\ua74b \ua74c\ua74d "
    "\ua74e\ua74f \ua750\ua751 \ua752\ua753 \ua754\ua755 \ua756\ua757 \ua758\ua759 \ua75a\ua75b \ua75c\ua75d \ua75e\ua75f "
    "\ua760\ua761 \ua762\ua763 \ua764\ua765 \ua766\ua767 \ua768\ua769 \ua76a\ua76b \ua76c\ua76d \ua76e\ua76f \ua779\ua77a "
    "\ua77b\ua77c \ua77d\u1d79 \ua77e\ua77f \ua780\ua781 \ua782\ua783 \ua784\ua785 \ua786\ua787 \ua78b\ua78c \ua78d\u0265 "
    "\ua790\ua791 \ua792\ua793 \ua796\ua797 \ua798\ua799 \ua79a\ua79b \ua79c\ua79d \ua79e\ua79f \ua7a0\ua7a1 \ua7a2\ua7a3 "
    "\ua7a4\ua7a5 \ua7a6\ua7a7 \ua7a8\ua7a9 \ua7aa\u0266 \ua7ab\u025c \ua7ac\u0261 \ua7ad\u026c \ua7ae\u026a \ua7b0\u029e "
    "\ua7b1\u0287 \ua7b2\u029d \ua7b3\uab53 \ua7b4\ua7b5 \ua7b6\ua7b7 \ua7b8\ua7b9 \ua7ba\ua7bb \ua7bc\ua7bd \ua7be\ua7bf "
    "\ua7c0\ua7c1 \ua7c2\ua7c3 \ua7c4\ua794 \ua7c5\u0282 \ua7c6\u1d8e \ua7c7\ua7c8 \ua7c9\ua7ca \ua7d0\ua7d1 \ua7d6\ua7d7 "
    "\ua7d8\ua7d9 \ua7f5\ua7f6 \uab70\u13a0 \uab71\u13a1 \uab72\u13a2 \uab73\u13a3 \uab74\u13a4 \uab75\u13a5 \uab76\u13a6 "
    "\uab77\u13a7 \uab78\u13a8 \uab79\u13a9 \uab7a\u13aa \uab7b\u13ab \uab7c\u13ac \uab7d\u13ad \uab7e\u13ae \uab7f\u13af "
    "\uab80\u13b0 \uab81\u13b1 \uab82\u13b2 \uab83\u13b3 \uab84\u13b4 \uab85\u13b5 \uab86\u13b6 \uab87\u13b7 \uab88\u13b8 "
    "\uab89\u13b9 \uab8a\u13ba \uab8b\u13bb \uab8c\u13bc \uab8d\u13bd \uab8e\u13be \uab8f\u13bf \uab90\u13c0 \uab91\u13c1 "
    "\uab92\u13c2 \uab93\u13c3 \uab94\u13c4 \uab95\u13c5 \uab96\u13c6 \uab97\u13c7 \uab98\u13c8 \uab99\u13c9 \uab9a\u13ca "
    "\uab9b\u13cb \uab9c\u13cc \uab9d\u13cd \uab9e\u13ce \uab9f\u13cf \uaba0\u13d0 \uaba1\u13d1 \uaba2\u13d2 \uaba3\u13d3 "
    "\uaba4\u13d4 \uaba5\u13d5 \uaba6\u13d6 \uaba7\u13d7 \uaba8\u13d8 \uaba9\u13d9 \uabaa\u13da \uabab\u13db \uabac\u13dc "
    "\uabad\u13dd \uabae\u13de \uabaf\u13df \uabb0\u13e0 \uabb1\u13e1 \uabb2\u13e2 \uabb3\u13e3 \uabb4\u13e4 \uabb5\u13e5 "
    "\uabb6\u13e6 \uabb7\u13e7 \uabb8\u13e8 \uabb9\u13e9 \uabba\u13ea \uabbb\u13eb \uabbc\u13ec \uabbd\u13ed \uabbe\u13ee "
    "\uabbf\u13ef \uf900\u8c48 \uf901\u66f4 \uf902\u8eca \uf903\u8cc8 \uf904\u6ed1 \uf905\u4e32 \uf906\u53e5 \uf907\u9f9c "
    "\uf908\u9f9c \uf909\u5951 \uf90a\u91d1 \uf90b\u5587 \uf90c\u5948 \uf90d\u61f6 \uf90e\u7669 \uf90f\u7f85 \uf910\u863f "
    "\uf911\u87ba \uf912\u88f8 \uf913\u908f \uf914\u6a02 \uf915\u6d1b \uf916\u70d9 \uf917\u73de \uf918\u843d \uf919\u916a "
    "\uf91a\u99f1 \uf91b\u4e82 \uf91c\u5375 \uf91d\u6b04 \uf91e\u721b \uf91f\u862d \uf920\u9e1e \uf921\u5d50 \uf922\u6feb "
    "\uf923\u85cd \uf924\u8964 \uf925\u62c9 \uf926\u81d8 \uf927\u881f \uf928\u5eca \uf929\u6717 \uf92a\u6d6a \uf92b\u72fc "
    "\uf92c\u90ce \uf92d\u4f86 \uf92e\u51b7 \uf92f\u52de \uf930\u64c4 \uf931\u6ad3 \uf932\u7210 \uf933\u76e7 \uf934\u8001 "
    "\uf935\u8606 \uf936\u865c \uf937\u8def \uf938\u9732 \uf939\u9b6f \uf93a\u9dfa \uf93b\u788c \uf93c\u797f \uf93d\u7da0 "
    "\uf93e\u83c9 \uf93f\u9304 \uf940\u9e7f \uf941\u8ad6 \uf942\u58df \uf943\u5f04 \uf944\u7c60 \uf945\u807e \uf946\u7262 "
    "\uf947\u78ca \uf948\u8cc2 \uf949\u96f7 \uf94a\u58d8 \uf94b\u5c62 \uf94c\u6a13 \uf94d\u6dda \uf94e\u6f0f \uf94f\u7d2f "
    "\uf950\u7e37 \uf951\u964b \uf952\u52d2 \uf953\u808b \uf954\u51dc \uf955\u51cc \uf956\u7a1c \uf957\u7dbe \uf958\u83f1 "
    "\uf959\u9675 \uf95a\u8b80 \uf95b\u62cf \uf95c\u6a02 \uf95d\u8afe \uf95e\u4e39 \uf95f\u5be7 \uf960\u6012 \uf961\u7387 "
    "\uf962\u7570 \uf963\u5317 \uf964\u78fb \uf965\u4fbf \uf966\u5fa9 \uf967\u4e0d \uf968\u6ccc \uf969\u6578 \uf96a\u7d22 "
    "\uf96b\u53c3 \uf96c\u585e \uf96d\u7701 \uf96e\u8449 \uf96f\u8aaa \uf970\u6bba \uf971\u8fb0 \uf972\u6c88 \uf973\u62fe "
    "\uf974\u82e5 \uf975\u63a0 \uf976\u7565 \uf977\u4eae \uf978\u5169 \uf979\u51c9 \uf97a\u6881 \uf97b\u7ce7 \uf97c\u826f "
    "\uf97d\u8ad2 \uf97e\u91cf \uf97f\u52f5 \uf980\u5442 \uf981\u5973 \uf982\u5eec \uf983\u65c5 \uf984\u6ffe \uf985\u792a "
    "\uf986\u95ad \uf987\u9a6a \uf988\u9e97 \uf989\u9ece \uf98a\u529b \uf98b\u66c6 \uf98c\u6b77 \uf98d\u8f62 \uf98e\u5e74 "
    "\uf98f\u6190 \uf990\u6200 \uf991\u649a \uf992\u6f23 \uf993\u7149 \uf994\u7489 \uf995\u79ca \uf996\u7df4 \uf997\u806f "
    "\uf998\u8f26 \uf999\u84ee \uf99a\u9023 \uf99b\u934a \uf99c\u5217 \uf99d\u52a3 \uf99e\u54bd \uf99f\u70c8 \uf9a0\u88c2 "
    "\uf9a1\u8aaa \uf9a2\u5ec9 \uf9a3\u5ff5 \uf9a4\u637b \uf9a5\u6bae \uf9a6\u7c3e \uf9a7\u7375 \uf9a8\u4ee4 \uf9a9\u56f9 "
    "\uf9aa\u5be7 \uf9ab\u5dba \uf9ac\u601c \uf9ad\u73b2 \uf9ae\u7469 \uf9af\u7f9a \uf9b0\u8046 \uf9b1\u9234 \uf9b2\u96f6 "
    "\uf9b3\u9748 \uf9b4\u9818 \uf9b5\u4f8b \uf9b6\u79ae \uf9b7\u91b4 \uf9b8\u96b8 \uf9b9\u60e1 \uf9ba\u4e86 \uf9bb\u50da "
    "\uf9bc\u5bee \uf9bd\u5c3f \uf9be\u6599 \uf9bf\u6a02 \uf9c0\u71ce \uf9c1\u7642 \uf9c2\u84fc \uf9c3\u907c \uf9c4\u9f8d "
    "\uf9c5\u6688 \uf9c6\u962e \uf9c7\u5289 \uf9c8\u677b \uf9c9\u67f3 \uf9ca\u6d41 \uf9cb\u6e9c \uf9cc\u7409 \uf9cd\u7559 "
    "\uf9ce\u786b \uf9cf\u7d10 \uf9d0\u985e \uf9d1\u516d \uf9d2\u622e \uf9d3\u9678 \uf9d4\u502b \uf9d5\u5d19 \uf9d6\u6dea "
    "\uf9d7\u8f2a \uf9d8\u5f8b \uf9d9\u6144 \uf9da\u6817 \uf9db\u7387 \uf9dc\u9686 \uf9dd\u5229 \uf9de\u540f \uf9df\u5c65 "
    "\uf9e0\u6613 \uf9e1\u674e \uf9e2\u68a8 \uf9e3\u6ce5 \uf9e4\u7406 \uf9e5\u75e2 \uf9e6\u7f79 \uf9e7\u88cf \uf9e8\u88e1 "
    "\uf9e9\u91cc \uf9ea\u96e2 \uf9eb\u533f \uf9ec\u6eba \uf9ed\u541d \uf9ee\u71d0 \uf9ef\u7498 \uf9f0\u85fa \uf9f1\u96a3 "
    "\uf9f2\u9c57 \uf9f3\u9e9f \uf9f4\u6797 \uf9f5\u6dcb \uf9f6\u81e8 \uf9f7\u7acb \uf9f8\u7b20 \uf9f9\u7c92 \uf9fa\u72c0 "
    "\uf9fb\u7099 \uf9fc\u8b58 \uf9fd\u4ec0 \uf9fe\u8336 \uf9ff\u523a \ufa00\u5207 \ufa01\u5ea6 \ufa02\u62d3 \ufa03\u7cd6 "
    "\ufa04\u5b85 \ufa05\u6d1e \ufa06\u66b4 \ufa07\u8f3b \ufa08\u884c \ufa09\u964d \ufa0a\u898b \ufa0b\u5ed3 \ufa0c\u5140 "
    "\ufa0d\u55c0 \ufa10\u585a \ufa12\u6674 \ufa15\u51de \ufa16\u732a \ufa17\u76ca \ufa18\u793c \ufa19\u795e \ufa1a\u7965 "
    "\ufa1b\u798f \ufa1c\u9756 \ufa1d\u7cbe \ufa1e\u7fbd \ufa20\u8612 \ufa22\u8af8 \ufa25\u9038 \ufa26\u90fd \ufa2a\u98ef "
    "\ufa2b\u98fc \ufa2c\u9928 \ufa2d\u9db4 \ufa2e\u90de \ufa2f\u96b7 \ufa30\u4fae \ufa31\u50e7 \ufa32\u514d \ufa33\u52c9 "
    "\ufa34\u52e4 \ufa35\u5351 \ufa36\u559d \ufa37\u5606 \ufa38\u5668 \ufa39\u5840 \ufa3a\u58a8 \ufa3b\u5c64 \ufa3c\u5c6e "
    "\ufa3d\u6094 \ufa3e\u6168 \ufa3f\u618e \ufa40\u61f2 \ufa41\u654f \ufa42\u65e2 \ufa43\u6691 \ufa44\u6885 \ufa45\u6d77 "
    "\ufa46\u6e1a \ufa47\u6f22 \ufa48\u716e \ufa49\u722b \ufa4a\u7422 \ufa4b\u7891 \ufa4c\u793e \ufa4d\u7949 \ufa4e\u7948 "
    "\ufa4f\u7950 \ufa50\u7956 \ufa51\u795d \ufa52\u798d \ufa53\u798e \ufa54\u7a40 \ufa55\u7a81 \ufa56\u7bc0 \ufa57\u7df4 "
    "\ufa58\u7e09 \ufa59\u7e41 \ufa5a\u7f72 \ufa5b\u8005 \ufa5c\u81ed \ufa5d\u8279 \ufa5e\u8279 \ufa5f\u8457 \ufa60\u8910 "
    "\ufa61\u8996 \ufa62\u8b01 \ufa63\u8b39 \ufa64\u8cd3 \ufa65\u8d08 \ufa66\u8fb6 \ufa67\u9038 \ufa68\u96e3 \ufa69\u97ff "
    "\ufa6a\u983b \ufa6b\u6075 \ufa6c\u242ee \ufa6d\u8218 \ufa70\u4e26 \ufa71\u51b5 \ufa72\u5168 \ufa73\u4f80 \ufa74\u5145 "
    "\ufa75\u5180 \ufa76\u52c7 \ufa77\u52fa \ufa78\u559d \ufa79\u5555 \ufa7a\u5599 \ufa7b\u55e2 \ufa7c\u585a \ufa7d\u58b3 "
    "\ufa7e\u5944 \ufa7f\u5954 \ufa80\u5a62 \ufa81\u5b28 \ufa82\u5ed2 \ufa83\u5ed9 \ufa84\u5f69 \ufa85\u5fad \ufa86\u60d8 "
    "\ufa87\u614e \ufa88\u6108 \ufa89\u618e \ufa8a\u6160 \ufa8b\u61f2 \ufa8c\u6234 \ufa8d\u63c4 \ufa8e\u641c \ufa8f\u6452 "
    "\ufa90\u6556 \ufa91\u6674 \ufa92\u6717 \ufa93\u671b \ufa94\u6756 \ufa95\u6b79 \ufa96\u6bba \ufa97\u6d41 \ufa98\u6edb "
    "\ufa99\u6ecb \ufa9a\u6f22 \ufa9b\u701e \ufa9c\u716e \ufa9d\u77a7 \ufa9e\u7235 \ufa9f\u72af \ufaa0\u732a \ufaa1\u7471 "
    "\ufaa2\u7506 \ufaa3\u753b \ufaa4\u761d \ufaa5\u761f \ufaa6\u76ca \ufaa7\u76db \ufaa8\u76f4 \ufaa9\u774a \ufaaa\u7740 "
    "\ufaab\u78cc \ufaac\u7ab1 \ufaad\u7bc0 \ufaae\u7c7b \ufaaf\u7d5b \ufab0\u7df4 \ufab1\u7f3e \ufab2\u8005 \ufab3\u8352 "
    "\ufab4\u83ef \ufab5\u8779 \ufab6\u8941 \ufab7\u8986 \ufab8\u8996 \ufab9\u8abf \ufaba\u8af8 \ufabb\u8acb \ufabc\u8b01 "
    "\ufabd\u8afe \ufabe\u8aed \ufabf\u8b39 \ufac0\u8b8a \ufac1\u8d08 \ufac2\u8f38 \ufac3\u9072 \ufac4\u9199 \ufac5\u9276 "
    "\ufac6\u967c \ufac7\u96e3 \ufac8\u9756 \ufac9\u97db \ufaca\u97ff \ufacb\u980b \ufacc\u983b \ufacd\u9b12 \uface\u9f9c "
    "\ufacf\u2284a \ufad0\u22844 \ufad1\u233d5 \ufad2\u3b9d \ufad3\u4018 \ufad4\u4039 \ufad5\u25249 \ufad6\u25cd0 "
    "\ufad7\u27ed3 \ufad8\u9f43 \ufad9\u9f8e \ufb00ff \ufb01fi \ufb02fl \ufb03ffi \ufb04ffl \ufb05st \ufb06st "
    "\ufb13\u0574\u0576 \ufb14\u0574\u0565 \ufb15\u0574\u056b \ufb16\u057e\u0576 \ufb17\u0574\u056d \ufb1d\u05d9 "
    "\ufb1f\u05f2 \ufb2a\u05e9 \ufb2b\u05e9 \ufb2c\u05e9 \ufb2d\u05e9 \ufb2e\u05d0 \ufb2f\u05d0 \ufb30\u05d0 \ufb31\u05d1 "
    "\ufb32\u05d2 \ufb33\u05d3 \ufb34\u05d4 \ufb35\u05d5 \ufb36\u05d6 \ufb38\u05d8 \ufb39\u05d9 \ufb3a\u05da \ufb3b\u05db "
    "\ufb3c\u05dc \ufb3e\u05de \ufb40\u05e0 \ufb41\u05e1 \ufb43\u05e3 \ufb44\u05e4 \ufb46\u05e6 \ufb47\u05e7 \ufb48\u05e8 "
    "\ufb49\u05e9 \ufb4a\u05ea \ufb4b\u05d5 \ufb4c\u05d1 \ufb4d\u05db \ufb4e\u05e4 \uff21\uff41 \uff22\uff42 \uff23\uff43 "
    "\uff24\uff44 \uff25\uff45 \uff26\uff46 \uff27\uff47 \uff28\uff48 \uff29\uff49 \uff2a\uff4a \uff2b\uff4b \uff2c\uff4c "
    "\uff2d\uff4d \uff2e\uff4e \uff2f\uff4f \uff30\uff50 \uff31\uff51 \uff32\uff52 \uff33\uff53 \uff34\uff54 \uff35\uff55 "
    "\uff36\uff56 \uff37\uff57 \uff38\uff58 \uff39\uff59 \uff3a\uff5a ";

}  // namespace letters_table

}  // namespace metagraph
